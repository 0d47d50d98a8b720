// Status and covariance of each pose: covariance DATA
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>

#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry.hpp"

namespace {

/// Whether a filter may take the pose as a measurement.
bool is_measured(rilo::OdometryStatus status) {
  return status == rilo::OdometryStatus::kOk || status == rilo::OdometryStatus::kRecovered ||
         status == rilo::OdometryStatus::kDegenerate;  // its covariance is large where nothing was seen
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: covariance DATA\n", stderr);
    return 2;
  }
  try {
    const auto source = rilo::open_scan_source(argv[1]);
    rilo::Odometry odometry(rilo::OdometryConfig{});
    rilo::SE3 before = rilo::SE3::Identity();
    // Of the pose in the odometry frame; what the odometry gives is that of the step from the pose before.
    rilo::Matrix6d covariance = rilo::Matrix6d::Zero();
    std::size_t measured = 0;
    while (const std::optional<rilo::Sweep> sweep = source->next()) {
      const rilo::SweepResult result = odometry.register_sweep(*sweep);
      // Right perturbation, [rotation; translation]: the old one, seen from the new pose, and the step's.
      const rilo::Matrix6d step = rilo::adjoint(result.T_odom_lidar.inverse() * before);
      covariance = step * covariance * step.transpose() + result.covariance;
      before = result.T_odom_lidar;
      measured += is_measured(result.status) ? 1 : 0;

      const Eigen::Matrix<double, 6, 1> sigma = covariance.diagonal().cwiseSqrt();
      std::printf("%s: position known to %.3f m, heading to %.3f deg, weakest direction %.4f of the strongest\n",
                  to_string(result.status).data(), sigma.tail<3>().norm(), sigma[2] * 180 / M_PI,
                  result.stats.relative_eigenvalues[0]);
    }
    std::printf("%zu of %zu poses measured\n", measured, odometry.trajectory().size());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "covariance: %s\n", error.what());
    return 1;
  }
}
