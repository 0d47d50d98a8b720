// Per-point times of the sweeps of one source, as its options say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/times/point_clock.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo::detail {

/// For SourceInfo::point_times.
std::string azimuth_description(SpinDirection direction, double period_s);

class SweepTiming {
 public:
  /// `period_s` is the one for azimuth times. `stamps_assumed`: the sweeps have no other stamps than those that times
  /// from an epoch give them, also where the points are not to have these times (none, order).
  SweepTiming(const SourceOptions& options, const PointTimeHints& hints, double period_s, bool stamps_assumed = false);

  /// Whether stored times are of any use.
  bool reads_times() const { return from_ == PointTimes::kAuto || for_stamps_; }

  /// Before the first sweep: the data promise times of that description, or none. `ends`: of the time field in the
  /// first sweeps (see add_time_ends()); a field that is the same for all points of a sweep is none. `stamps_ns`: their
  /// stamps, as long as `ends`.
  void promise(const std::optional<std::string>& times, const std::vector<RawTimes>& ends = {},
               const std::vector<std::int64_t>& stamps_ns = {});

  /// Fills sweep.times_s (and the stamp, when the times count from an epoch) from `times`, the azimuth, or not at all.
  /// In data stamped so, a sweep without times is stamped by those around it.
  /// `forward_after_s`: from the stamp to the time when the sensor faces forward, for azimuth times.
  /// @throws IoError when the times make no sense; `file` is for its message.
  void apply(const std::optional<RawTimes>& times, const std::filesystem::path& file, double forward_after_s,
             Sweep& sweep);

  bool has_times() const { return has_times_; }
  const std::string& description() const { return description_; }
  /// Sentences about the times, for SourceInfo::warnings.
  std::vector<std::string> warnings() const;
  /// The points' times count from an epoch: they set the stamps.
  bool sets_stamps() const;
  /// Where the stamps are assumed: the period that the promised times show.
  struct ShownPeriod {
    double s = 0;
    bool by_stamps = false;  ///< by the steps of times from an epoch; false: sweeps last longer than assumed, so long
  };
  const std::optional<ShownPeriod>& shown_period() const { return shown_period_; }

 private:
  void stamp(const std::optional<RawTimes>& times, const std::filesystem::path& file, Sweep& sweep);
  void expect_clock(const std::vector<RawTimes>& ends, const std::vector<std::int64_t>& stamps_ns);

  PointTimes from_;
  bool for_stamps_;  // stored times alone, which the points do not get
  SpinDirection spin_;
  double period_s_;
  bool infers_unit_;
  bool stamps_in_field_;  // one stamp for all points of a sweep is enough
  PointTimeDecoder decoder_;
  PointClock clock_;
  std::optional<ShownPeriod> shown_period_;
  bool constant_ = false;         // the field, in all sweeps so far
  std::string constant_warning_;  // empty unless the first sweeps have such a field
  bool has_times_ = false;
  std::string description_ = "none";
};

}  // namespace rilo::detail
