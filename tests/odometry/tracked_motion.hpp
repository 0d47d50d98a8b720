// Sweeps for tests of what follows the motion.
#pragma once

#include <cstdint>

#include <Eigen/Cholesky>

#include "odometry/motion_tracker.hpp"

namespace rilo::test {

inline constexpr std::int64_t kStepNs = 100'000'000;

inline SweepTime after(std::int64_t step_ns) { return {0, step_ns, step_ns}; }

inline IcpResult at(double x) {
  IcpResult icp;
  icp.state.T_odom_lidar.translation().x() = x;
  icp.state.twist[3] = 10.0;
  icp.posterior_information.setIdentity();
  return icp;
}

/// Three sweeps, 1 m apart at 10 m/s; the last is at x = 2 m.
inline MotionTracker driving() {
  MotionTracker tracker({}, {}, {});
  tracker.begin({});
  for (const double x : {1.0, 2.0}) {
    tracker.advance(after(kStepNs));
    tracker.accept(at(x), MotionVerdict::kPossible, false);
  }
  return tracker;
}

inline double x_of(const MotionState& state) { return state.T_odom_lidar.translation().x(); }

inline Matrix12d covariance_of(const MotionPrior& prior) {
  return prior.information.ldlt().solve(Matrix12d::Identity());
}

}  // namespace rilo::test
