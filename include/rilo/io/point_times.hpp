// The one place that interprets per-point times.
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
  PointTimeUnit unit = PointTimeUnit::kSeconds;               ///< never kInfer
  PointTimeReference reference = PointTimeReference::kStamp;  ///< never kInfer

  friend bool operator==(const PointTimeConvention&, const PointTimeConvention&) = default;
};

/// What is known before the first time is seen.
struct PointTimeHints {
  PointTimeUnit unit = PointTimeUnit::kInfer;
  PointTimeReference reference = PointTimeReference::kInfer;
  std::optional<double> period_s;  ///< of the sweeps, when stamps give it
  double assumed_period_s = 0.1;   ///< for fractions, when no stamps give it
  bool unit_certain = false;       ///< by definition of the data: `unit` is not checked
};

/// Converts a field as stored in the file into Sweep::times_s (and the stamp, when the times count from an epoch). The
/// convention is inferred from name, type and span of the first sweep that decides, and kept.
class PointTimeDecoder {
 public:
  explicit PointTimeDecoder(const PointTimeHints& hints) : hints_(hints) {}

  /// Before the first sweep, and not needed: first and last time of the bulk (without single wrong times) of some of
  /// the first sweeps. The widest that shows a unit decides it: one that is a part of a sweep tells nothing. Times that
  /// advance from sweep to sweep count from an epoch, however near zero.
  void learn(const std::vector<RawTimes>& ends);

  /// Fills sweep.times_s from `raw`, which is as long as sweep.points; sets sweep.stamp_ns to the earliest point when
  /// the times count from an epoch. Points without a finite time become NaN, as do a few whose times are too far from
  /// those of the others to be of the same sweep. Points that are not a measurement (NaN, or
  /// exactly at the origin) take no part in the decision and get time 0. `file` is for messages. Returns whether there
  /// is a time at all; where there is none, the stamp stays.
  /// @throws IoError, with the numbers and the option to set, when the convention is ambiguous or a sweep contradicts
  /// it.
  bool decode(const RawTimes& raw, const std::filesystem::path& file, Sweep& sweep);

  /// What was decided; nothing before the first sweep that decides.
  const std::optional<PointTimeConvention>& convention() const { return convention_; }

  /// For people: "field t (uint32), ns since the sweep's stamp"; empty before the decision.
  const std::string& description() const { return description_; }

  /// A sentence about the first sweep with points whose times are wrong, or that lasts too long; empty without.
  const std::string& warning() const { return warning_; }

 private:
  PointTimeConvention convention_of(const RawTimes& raw, const std::filesystem::path& file, const Sweep& sweep) const;

  PointTimeHints hints_;
  std::optional<PointTimeUnit> learnt_unit_;
  bool advances_ = false;
  std::optional<PointTimeConvention> convention_;
  std::string description_;
  std::string warning_;
};

/// Times of a spinning sensor whose timestamp is that of the forward direction (azimuth 0): time = -azimuth / 2π ·
/// period for clockwise, seen from above, else +; within ± period / 2. NaN points get 0.
std::vector<float> azimuth_times(const std::vector<Eigen::Vector3f>& points, double period_s, SpinDirection direction);

/// Times of points that lie in the order in which a sensor that turns measured them, whatever the direction, the seam
/// and the angle of a sweep: the share of the angle that is swept before a point, of `period_s`. Nothing when the
/// points do not go round once, in one direction, or are too few to tell. Points without a measurement, or within 0.1 m
/// of the sensor's axis, are timed by their place.
std::optional<std::vector<float>> order_times(const std::vector<Eigen::Vector3f>& points, double period_s);

/// The stamp of a pose at the middle of a sweep: `middle_ns`, or the sweep's own stamp when they are at most a
/// microsecond apart. The azimuth times of measured points are not quite symmetric about the stamp; without this the
/// first pose of a recording that begins at 0 would have a negative stamp.
std::int64_t pose_stamp_ns(std::int64_t middle_ns, std::int64_t sweep_stamp_ns);

}  // namespace rilo
