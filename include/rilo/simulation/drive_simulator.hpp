// Sweeps of a spinning LiDAR on a vehicle that drives through a procedural town, with the exact poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

enum class SensorKind : std::uint8_t { kHdl64, kVlp16, kOs1 };

/// hdl64, vlp16, os1-64.
std::string_view to_string(SensorKind kind);
std::optional<SensorKind> parse_sensor_kind(std::string_view text);

/// Geometry of a sensor that spins clockwise (seen from above) once per sweep, from straight behind to straight behind,
/// so that the middle of the sweep looks ahead. All beams of a column fire together.
struct SensorModel {
  SensorKind kind = SensorKind::kHdl64;
  std::vector<double> elevations_rad;  ///< one per beam (ring), topmost first
  std::size_t columns = 0;             ///< firings per sweep
  double period_s = 0.1;               ///< one sweep
  double min_range_m = 0;
  double max_range_m = 0;
  double mount_height_m = 0;  ///< above the ground, as it is mounted on the simulated vehicle

  std::size_t beams() const { return elevations_rad.size(); }
  /// Azimuth (rad, counter-clockwise from straight ahead) of the firing at `fraction` (0 … 1) of the sweep.
  static double azimuth_rad(double fraction);
};

SensorModel sensor_model(SensorKind kind);

/// A drive through a small town. Everything follows from these values alone: the same configuration gives the same
/// bytes, whatever `threads` is.
struct DriveConfig {
  std::uint64_t seed = 1;  ///< town, traffic and noise
  SensorKind sensor = SensorKind::kHdl64;
  std::size_t sweeps = 0;         ///< 10 a second; 0: one lap and 50 m of the next; at most 20000
  double start_s = 0;             ///< s, 0 … 2000: begin this far into the drive (0: standing)
  double speed_mps = 10.5;        ///< m/s, 2 … 15: on straight streets; bends are taken slower
  bool deskewed = false;          ///< points referred to the mid-sweep pose, without times; else each at its own time
  double noise_m = 0.015;         ///< m, 0 … 0.5: standard deviation of a range
  double dropout = 0.02;          ///< share 0 … 0.9 of returns that are lost
  double max_range_m = 0;         ///< m, 5 … the sensor's own; 0: the sensor's own
  double elevation_bias_deg = 0;  ///< degrees, -2 … 2: true minus reported elevation (KITTI's is near 0.205)
  std::size_t moving_cars = 6;    ///< 0 … 12: some ahead and behind, the others oncoming
  double parked_cars = 0.5;       ///< 0 … 1: share of the parking places that are taken
  double trees = 0.6;             ///< 0 … 1: share of the places for trees that have one
  int threads = 0;                ///< 0 … 1024; 0: as many as the machine has

  /// @throws std::invalid_argument naming the field, its value and its range.
  void validate() const;
};

class DrivePath;

/// One sweep and its true poses. Points in order of firing, topmost beam first. `sweep.stamp_ns` is the start of the
/// sweep, counted from the first sweep's; `times_s` 0 … 0.1 s, empty when deskewed; `intensities` 0 … 1; `rings` 0 for
/// the topmost beam. Each pose is relative to the first sweep's pose at the SAME time: all three begin with the
/// identity.
struct SimulatedSweep {
  Sweep sweep;
  SE3 T_odom_lidar_start = SE3::Identity();
  SE3 T_odom_lidar_mid = SE3::Identity();
  SE3 T_odom_lidar_end = SE3::Identity();
};

/// Ray-casts sweeps on request, in any order; safe to call from several threads.
class DriveSimulator {
 public:
  /// @throws std::invalid_argument when a value of `config` is out of range.
  explicit DriveSimulator(const DriveConfig& config);
  ~DriveSimulator();
  DriveSimulator(DriveSimulator&&) noexcept;
  DriveSimulator& operator=(DriveSimulator&&) noexcept;

  /// Number of sweeps of the drive.
  std::size_t size() const;
  /// The i-th sweep. @throws std::out_of_range when i >= size().
  SimulatedSweep sweep(std::size_t i) const;

  /// Exact pose of the sensor `t_s` seconds after the start of the first sweep, world frame (z up).
  SE3 pose_at(double t_s) const;
  /// As given, with the number of sweeps filled in.
  const DriveConfig& config() const;
  const SensorModel& sensor() const;
  const DrivePath& path() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace rilo
