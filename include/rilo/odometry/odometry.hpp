// LiDAR odometry: sweeps in, poses and a local map out.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/known_velocity.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// The pipeline of the paper, one call per sweep. Not thread-safe: one thread calls it; inside it uses `threads`
/// threads and gives the same bits for any number of them.
class Odometry {
 public:
  /// Monotonic time in ns for the stage times in the statistics and for the time budget. The core itself reads no
  /// clock. With a time budget it is called from several threads at once.
  using Clock = std::function<std::int64_t()>;

  /// @throws std::invalid_argument when a configuration value is out of range (it is named, with its range), or when
  /// there is a time budget and no clock.
  explicit Odometry(const OdometryConfig& config, Clock clock = {});
  ~Odometry();
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;

  /// Registers one sweep (a Sweep or a view of one, which is not used after the call). Stamps must increase; a sweep
  /// whose stamp does not is registered as if one usual period had passed. Never throws on bad data: the status in the
  /// result reports it.
  /// @throws std::invalid_argument when times, intensities or rings are neither none nor as many as the points, or
  /// when start_with() was given the angles of another sensor; the sweep is not registered.
  SweepResult register_sweep(const SweepView& sweep);

  /// Poses so far, one per registered sweep.
  const Trajectory& trajectory() const;

  /// Points of the local map, odometry frame (m).
  std::vector<Eigen::Vector3f> local_map() const;

  /// Points of the last sweep that went into the map, motion-compensated, sensor frame at the time of the pose (m).
  const std::vector<Eigen::Vector3f>& last_map_points() const;

  /// Whether last_map_intensities() are wanted, from the next sweep on.
  void keep_intensities(bool kept);

  /// Mean intensities of last_map_points(); empty when they are not kept or the sweep had none.
  const std::vector<float>& last_map_intensities() const;

  /// Forgets map, trajectory and motion; the next sweep starts at the identity again, with what start_with() was given.
  void reset();

  /// As reset(), with what is known about the sensor: its elevation offset, instead of the configured one, and the
  /// angles of its beams correct the points from the next sweep on. Both are learnt further.
  void start_with(const SensorAngles& known);

  /// What is known about the sensor by now, to start with in another recording: its elevation offset, as far as that is
  /// certain, and the angles of the beams seen.
  SensorAngles sensor_angles() const;

  /// As reset(), but what was learnt about the sensor stays: its elevation offset, if that is certain, and the angles
  /// of its beams correct the points from the next sweep on. With a `velocity` the maps that begin before its time
  /// begin with it: a second sweep alone may not tell the motion. Returns the elevation offset (rad).
  double start_over(const std::optional<KnownVelocity>& velocity = std::nullopt);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rilo
