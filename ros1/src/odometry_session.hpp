// The odometry on the sweeps of a queue, in the frames that the robot uses. C++17, as ROS 1's headers need it: what is
// behind it is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "node_options.hpp"
#include "rilo/geometry/trajectory.hpp"
#include "rilo/io/live_queue.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo::ros1 {

/// What was decided and counted about the sweeps so far (StampFaults, SourceInfo).
struct SourceFigures {
  std::size_t gaps = 0;
  std::size_t missing = 0;
  std::size_t duplicates = 0;
  std::size_t out_of_order = 0;
  std::size_t clock_jumps = 0;
  std::string point_times = "none";
  std::string lidar_frame;
};

/// Poses, path and maps are those of the base in odom_frame: base_to_lidar and what set_pose() said are in them.
/// next_sweep() is for one thread; the rest is, with another lock of the caller, for one thread at a time.
class OdometrySession {
 public:
  /// @throws std::invalid_argument as Odometry.
  OdometrySession(const NodeOptions& options, std::shared_ptr<LiveQueue> queue);
  ~OdometrySession();
  OdometrySession(const OdometrySession&) = delete;
  OdometrySession& operator=(const OdometrySession&) = delete;

  /// Waits for the next sweep and keeps it. False when the queue was closed. @throws IoError when it cannot be read.
  bool next_sweep();
  SourceFigures figures() const;

  /// Before the first sweep is registered.
  void set_extrinsic(const SE3& T_base_lidar);

  /// Registers the sweep kept.
  SweepResult register_sweep();

  /// Time between the last two poses, s; 0 without two.
  double last_step_s() const;

  void reset();

  /// The base was there at the last sweep (before the first: is there at the first).
  void set_pose(const SE3& T_odom_base);

  Trajectory path() const;
  std::vector<Eigen::Vector3f> local_map() const;

  /// Of the whole run since the last reset; the local one where none is kept.
  std::vector<Eigen::Vector3f> map() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// As rilo::write_map. @throws IoError
void save_map(const std::string& file, const std::vector<Eigen::Vector3f>& points);

}  // namespace rilo::ros1
