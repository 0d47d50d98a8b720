// Options of scan sources.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rilo {

/// Where the per-point times come from.
enum class PointTimes : std::uint8_t {
  kAuto,     ///< from the data when it has them, else none
  kNone,     ///< ignored: every point is taken at the sweep's stamp
  kAzimuth,  ///< from the azimuth of a spinning sensor whose sweep is stamped when it faces forward
  kOrder,    ///< from the order of the points, as a spinning sensor measured them
};
/// auto, none, azimuth, order.
std::string_view to_string(PointTimes value);
std::optional<PointTimes> parse_point_times(std::string_view text);

/// Unit of a per-point time field.
enum class PointTimeUnit : std::uint8_t {
  kInfer,         ///< from the field's span; rejected when ambiguous
  kSeconds,       ///< s
  kMilliseconds,  ///< ms
  kMicroseconds,  ///< µs
  kNanoseconds,   ///< ns
  kFraction,      ///< 0 … 1 of the sweep's period
};
/// infer, s, ms, us, ns, fraction.
std::string_view to_string(PointTimeUnit value);
std::optional<PointTimeUnit> parse_point_time_unit(std::string_view text);

/// What a per-point time field counts from.
enum class PointTimeReference : std::uint8_t {
  kInfer,  ///< from the size of the values; rejected when ambiguous
  kStamp,  ///< the sweep's stamp
  kEpoch,  ///< an epoch shared by all sweeps: the stamp is the time of the earliest point
};
/// infer, stamp, epoch.
std::string_view to_string(PointTimeReference value);
std::optional<PointTimeReference> parse_point_time_reference(std::string_view text);

/// Rotation direction of a spinning sensor, seen from above.
enum class SpinDirection : std::uint8_t { kClockwise, kCounterClockwise };
/// clockwise, counter-clockwise.
std::string_view to_string(SpinDirection value);
std::optional<SpinDirection> parse_spin_direction(std::string_view text);

/// Handling of a sweep that cannot be read.
enum class OnBadSweep : std::uint8_t { kFail, kSkip };
/// fail, skip.
std::string_view to_string(OnBadSweep value);

struct SourceOptions {
  std::string topic;  ///< of a recording; empty: the only topic of clouds, or else of packets
  /// What a recording of packets needs: an Ouster's metadata (JSON; empty: the one in or beside the recording), or the
  /// calibration of a Velodyne HDL-64E (YAML of the ROS driver velodyne_pointcloud).
  std::string sensor_file;
  /// Columns of a .bin record, one float32 each: x, y, z (needed), intensity, time, ring; `_` is ignored.
  /// auto: x,y,z,intensity, and a ring where the sizes or names of the files indicate one (nuScenes).
  std::string bin_fields = "auto";
  PointTimes point_times = PointTimes::kAuto;
  PointTimeUnit point_time_unit = PointTimeUnit::kInfer;
  PointTimeReference point_time_reference = PointTimeReference::kInfer;
  /// Name of the field (PCD, PLY, PointCloud2) that holds the point times; empty: the first of the usual names.
  std::string time_field;
  SpinDirection spin_direction = SpinDirection::kClockwise;  ///< for PointTimes::kAzimuth
  double elevation_correction_deg = 0;  ///< added to every point's elevation angle; KITTI's HDL-64E needs 0.205
  /// Sweeps a second of data without stamps. None: 10 are assumed, and a run of two passes may find that they are a
  /// fifth of that.
  std::optional<double> rate_hz;
  static constexpr int kMostParts = 1000;
  /// Messages or files that hold a sweep in parts, to be joined to one. 0: found out where they come faster than 13 a
  /// second; 1: none are joined.
  int parts = 0;
  OnBadSweep on_bad_sweep = OnBadSweep::kFail;
  std::size_t read_ahead = 2;  ///< sweeps read ahead on a background thread; 0: none

  double assumed_rate_hz() const { return rate_hz.value_or(10); }
};

}  // namespace rilo
