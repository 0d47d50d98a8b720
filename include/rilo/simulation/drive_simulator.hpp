// Sweeps of a spinning LiDAR on a vehicle that drives through a procedural town, with the exact poses.
#pragma once

#include <cstddef>
#include <memory>

#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/simulation/drive_config.hpp"
#include "rilo/simulation/sensor_model.hpp"

namespace rilo {

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
