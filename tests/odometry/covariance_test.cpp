// The reported covariance against the truth of simulated drives.
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

constexpr std::size_t kSettledAfter = 8;  // the first map is thin

/// Root mean square of the normalised errors of all steps from one sweep to the next, over six degrees of freedom: 1
/// for an exact covariance, above it the poses are worse than reported.
double normalised_error(const DriveConfig& drive) {
  const DriveSimulator simulator(drive);
  Odometry odometry({});
  SE3 last = SE3::Identity();
  SE3 last_truth = SE3::Identity();
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const SimulatedSweep s = simulator.sweep(i);
    const SweepResult result = odometry.register_sweep(s.sweep);
    const SE3 truth = last_truth.inverse() * s.T_odom_lidar_mid;
    const Vector6d error = se3_log(truth.inverse() * (last.inverse() * result.T_odom_lidar));
    if (i >= kSettledAfter) {
      sum += error.dot(result.covariance.ldlt().solve(error));
      count += 6;
    }
    last = result.T_odom_lidar;
    last_truth = s.T_odom_lidar_mid;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

TEST(Covariance, IsThatOfTheErrorsWithinAFactorOfTwo) {
  double sum = 0;
  int drives = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    for (const bool deskewed : {false, true}) {
      DriveConfig drive;
      drive.sensor = SensorKind::kVlp16;
      drive.sweeps = 28;
      drive.start_s = 6.0;
      drive.seed = seed;
      drive.deskewed = deskewed;
      const double rms = normalised_error(drive);
      sum += rms * rms;
      ++drives;
    }
  }
  const double rms = std::sqrt(sum / drives);
  EXPECT_GT(rms, 0.5);
  EXPECT_LT(rms, 2.0);
}

}  // namespace
}  // namespace rilo
