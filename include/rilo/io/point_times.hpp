// The one place that decides what per-point times mean.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo {

/// Unit and reference of a time field.
struct PointTimeConvention {
  PointTimeUnit unit = PointTimeUnit::kSeconds;
  bool absolute = false;  ///< counts from an epoch; else from the sweep's stamp

  friend bool operator==(const PointTimeConvention&, const PointTimeConvention&) = default;
};

/// Turns a field as it stands in the file into Sweep::times_s (and the stamp, when the times are absolute). The
/// convention is inferred from name, type and span of the first sweep that has times, and kept.
class PointTimeDecoder {
 public:
  /// `period_s`: the sweep's period when it is known from stamps.
  PointTimeDecoder(PointTimeUnit unit, std::optional<double> period_s) : unit_(unit), period_s_(period_s) {}

  /// Fills sweep.times_s, and sweep.stamp_ns when the times are absolute (the earliest point then has time 0). Points
  /// without a finite time become NaN. `file` is for messages.
  /// @throws IoError, with the numbers and the option to set, when the convention is ambiguous or a sweep contradicts
  /// it.
  void decode(const RawTimes& raw, const std::filesystem::path& file, Sweep& sweep);

  /// What was decided; nothing before the first sweep with times.
  const std::optional<PointTimeConvention>& convention() const { return convention_; }

  /// For people: "field t (uint32), ns since the sweep's stamp".
  const std::string& description() const { return description_; }

 private:
  PointTimeUnit unit_;
  std::optional<double> period_s_;
  std::optional<PointTimeConvention> convention_;
  std::string description_;
};

/// Times of a spinning sensor that is stamped when it faces forward (azimuth 0): time = -azimuth / 2π · period for
/// clockwise, seen from above, else +; within ± period / 2.
std::vector<float> azimuth_times(const std::vector<Eigen::Vector3f>& points, double period_s, SpinDirection direction);

}  // namespace rilo
