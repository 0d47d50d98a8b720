// What every source is wrapped into.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// Another source, as it is; what derives from it changes its sweeps.
class WrappedSource : public ScanSource {
 public:
  explicit WrappedSource(std::unique_ptr<ScanSource> inner) : inner_(std::move(inner)) {}

  std::optional<Sweep> next() override { return inner_->next(); }
  std::size_t skip(std::size_t count) override { return inner_->skip(count); }
  std::optional<std::size_t> size() const override { return inner_->size(); }
  std::size_t current_index() const override { return inner_->current_index(); }
  std::string current_name() const override { return inner_->current_name(); }
  SourceInfo info() const override { return inner_->info(); }

 protected:
  std::unique_ptr<ScanSource> inner_;  // NOLINT(*-non-private-member-variables-in-classes)
};

/// Watches the stamps of `inner`: counts gaps, drops duplicates and sweeps that come after a newer one, and goes
/// on when the clock was set back. See StampFaults.
std::unique_ptr<ScanSource> with_stamp_order(std::unique_ptr<ScanSource> inner);

/// Adds `offset_deg` to the elevation angle of every point: a rotation about p × z, range and azimuth stay. Points on
/// the z axis have no such axis and stay.
void correct_elevation(std::vector<Eigen::Vector3f>& points, double offset_deg);

/// Joins `parts` sweeps of `inner` to one, its stamp that of the first, but none across a gap. 0: as many as
/// PartsOfSweep finds in the first 0.25 s, which are read at once where they come that fast, and info() says so. Points
/// without times are taken at the stamp of their part.
std::unique_ptr<ScanSource> with_joined_parts(std::unique_ptr<ScanSource> inner, std::size_t parts);

/// Applies correct_elevation to every sweep of `inner` and says so in info().
std::unique_ptr<ScanSource> with_elevation_correction(std::unique_ptr<ScanSource> inner, double offset_deg);

/// Gives every sweep of `inner` the times of order_times() over `turn_s`, by default that of its period, and says so in
/// info(). Its next() throws IoError until a sweep lies in order; one that does not after that is timed by the places
/// of its points.
std::unique_ptr<ScanSource> with_order_times(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s = {});

/// Gives every sweep of `inner` the times of azimuth_times(), clockwise, over `turn_s` likewise, and says so in info().
std::unique_ptr<ScanSource> with_azimuth_times(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s = {});

/// Data without stamps, whose sweeps are taken to be so many times as far apart as was assumed.
std::unique_ptr<ScanSource> with_slower_stamps(std::unique_ptr<ScanSource> inner, int times);

/// Warns of options that make no difference to the data of `inner`, which has just been opened, and of fields of the
/// data that may hold times and are not used.
std::unique_ptr<ScanSource> with_option_warnings(std::unique_ptr<ScanSource> inner, const SourceOptions& options);

/// The part about the fields.
std::unique_ptr<ScanSource> with_field_warnings(std::unique_ptr<ScanSource> inner, const SourceOptions& options);

/// Reads up to `depth` sweeps (one at least) ahead on a background thread, which starts at the first next(). The order
/// and the errors are those of `inner`: an exception is rethrown by the next() that would have thrown it. The
/// destructor waits for the sweep that is being read.
std::unique_ptr<ScanSource> with_read_ahead(std::unique_ptr<ScanSource> inner, std::size_t depth);

}  // namespace rilo::detail
