#include "odometry/pose_covariance.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "odometry/motion_prior.hpp"
#include "odometry/running_mean.hpp"

namespace rilo {

namespace {
// The registration counts one residual in a hundred as independent, so that the prior is not outweighed. Against the
// truth of the simulator the poses are as good as if it were this many times more (docs/benchmarks.md), except where a
// direction is hidden: there what the surfaces share in error leaks into the others.
constexpr double kEvidenceWorth = 30.0;
// A velocity that changes steadily by a within the sweep moves its points by a t² / 2 against the middle: a T² / 24 on
// average over the sweep.
constexpr double kMeanLag = 1.0 / 24.0;
// Share of the mean square of the oscillation within the sweep that is in the pose: measured on the handheld drive and
// eleven others.
constexpr double kUnevenShare = 0.4;
}  // namespace

double PoseCovariance::evidence_share(const AdaptiveIcpConfig& config) {
  return kEvidenceWorth * config.independent_share;
}

Matrix6d PoseCovariance::of(const IcpResult& icp, bool degenerate, const Vector6d& acceleration, double sweep_s,
                            const Vector6d& uneven) {
  Matrix12d information = icp.posterior_information;
  // No less than is known of a guess: without the prior a direction may not be seen at all.
  information.diagonal().head<6>() += guess_covariance().diagonal().cwiseInverse();
  information.diagonal().tail<6>() += unknown_velocity_covariance().diagonal().cwiseInverse();
  if (!degenerate) {
    information += (kEvidenceWorth - 1.0) * icp.sweep_information;
  }
  const Matrix12d covariance = information.ldlt().solve(Matrix12d::Identity());
  // The registration perturbs rotation and translation along the axes of the odometry frame; the result is in the
  // sensor's own.
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  Matrix6d to_body = Matrix6d::Zero();
  to_body.topLeftCorner<3, 3>() = R.transpose();
  to_body.bottomRightCorner<3, 3>() = R.transpose();
  Matrix6d result = to_body * covariance.topLeftCorner<6, 6>() * to_body.transpose();

  if (icp.termination == IcpTermination::kTimeLimit) {
    // Updates shrink by about a half from one to the next: what is left is about as much as the last one.
    const Vector6d left = to_body * icp.last_update;
    result += left * left.transpose();
  }

  // The points are compensated for the mean acceleration since the sweep before, which is that of half a sweep ago. A
  // part of its change goes on (EarlierVelocity::share); half of it counts all the same, as the handheld drives ask
  // for.
  const bool compensated = icp.state.earlier.lag_s > 0.0;
  const Vector6d missed = compensated ? Vector6d(0.5 * (acceleration - acceleration_)) : acceleration;
  acceleration_ = acceleration;
  squared_acceleration_ += kRunningShare * (missed.cwiseAbs2() - squared_acceleration_);
  result.diagonal() += std::pow(kMeanLag * sweep_s * sweep_s, 2) * squared_acceleration_;
  uneven_ += kRunningShare * (uneven - uneven_);
  result.diagonal() += kUnevenShare * uneven_;
  return result;
}

}  // namespace rilo
