// What the benchmarks work on: a simulated drive, and the odometry's parts in the middle of it.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/preprocess.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::bench {

/// Sweeps of an HDL-64 on a moving vehicle, with point times; simulated at the first call.
const std::vector<SimulatedSweep>& drive();

/// The default configuration with one thread.
OdometryConfig single_thread();

/// The parts as they stand when the last sweep of the drive is about to be registered, at the true poses.
struct Scene {
  PreparedSweep before;                             ///< the sweep before the last
  PreparedSweep last;                               ///< the last sweep
  MotionState state;                                ///< true state at the last sweep
  SE3 T_before_last = SE3::Identity();              ///< true motion between the two
  std::vector<Eigen::Vector3f> before_compensated;  ///< source cloud of `before`, motion-compensated
  std::vector<Eigen::Vector3f> source_compensated;  ///< source cloud of `last`, motion-compensated
  std::vector<Eigen::Vector3f> map_compensated;     ///< map cloud of `last`, motion-compensated
  LocalMap map;                                     ///< of all sweeps but the last

  Scene();
};

/// Made at the first call.
const Scene& scene();

}  // namespace rilo::bench
