// The odometry on the sweeps of a queue, in the frames that the robot uses.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "node/node_health.hpp"
#include "node/path_poses.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/geometry/trajectory.hpp"
#include "rilo/io/live_queue.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/node/node_parameters.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// Poses, path and maps are those of the base in odom_frame: base_to_lidar and what set_pose() said are in them.
/// next_sweep() is for one thread; the rest is, with another lock of the caller, for one thread at a time.
class OdometrySession {
 public:
  /// @throws std::invalid_argument as Odometry.
  OdometrySession(const NodeOptions& options, std::shared_ptr<LiveQueue> queue);

  /// Waits for the next sweep and keeps it. False when the queue was closed. @throws IoError when it cannot be read.
  /// After open_anew() what the messages look like is found out again.
  bool next_sweep();
  /// Any thread.
  void open_anew() { queue_->end_source(); }
  /// How often that was done.
  std::size_t times_opened() const { return times_opened_; }
  SourceFigures figures() const;
  /// Sentences about the sweep kept and those before, each once.
  std::vector<std::string> new_warnings();

  /// Before the first sweep is registered.
  void set_extrinsic(const SE3& T_base_lidar);

  /// Registers the sweep kept.
  SweepResult register_sweep();
  /// Takes its points into the map of the whole run, where they belong in one.
  void add_to_map(OdometryStatus status);

  /// Time between the last two poses, s; 0 without two.
  double last_step_s() const;

  /// Restarts, with another configuration when one is given.
  void reset(const std::optional<OdometryConfig>& config = std::nullopt);

  /// The base was there at the last sweep (before the first: is there at the first).
  void set_pose(const SE3& T_odom_base);

  /// Thinned where it is long (PathPoses).
  Trajectory path() const;
  std::vector<Eigen::Vector3f> local_map() const;

  /// Of the whole run since the last reset; the local one where none is kept.
  std::vector<Eigen::Vector3f> map() const;
  std::size_t map_points() const { return map_ ? map_->size() : 0; }
  /// It has as many points as it may have.
  bool map_is_full() const { return map_ && most_map_points_ > 0 && map_->size() >= most_map_points_; }

 private:
  // New, with what is known about the sensor.
  Odometry new_odometry(const OdometryConfig& config) const;
  std::vector<Eigen::Vector3f> in_odom_frame(std::vector<Eigen::Vector3f> points) const;

  SourceOptions source_options_;
  std::optional<SensorAngles> calibration_;
  std::shared_ptr<LiveQueue> queue_;
  std::unique_ptr<ScanSource> source_;
  std::size_t times_opened_ = 0;
  SourceFigures figures_before_;    // of the sources opened before
  std::vector<std::string> given_;  // warnings
  bool untimed_ = false;            // some points were
  std::optional<Sweep> sweep_;
  Odometry odometry_;
  PathPoses path_;
  double map_voxel_m_;
  std::size_t most_map_points_;
  std::optional<ThinnedMap> map_;
  SE3 T_base_lidar_;
  SE3 T_world_odom_ = SE3::Identity();  // what set_pose() said
};

}  // namespace rilo
