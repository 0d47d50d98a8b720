#include "odometry/stamp_trust.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace rilo {

namespace {
constexpr double kMostInformation = 100.0;  // the share is known to ±0.1 at best, since a clock may change
}

double StampTrust::share() const { return std::clamp(share_, 0.0, 1.0); }

double StampTrust::error_s(double deviation_s) const {
  // Of deviations that have both causes, s of the mean square from motion, the best estimate leaves s (1 − s).
  const double mixed_s2 = share() * (1.0 - share()) * mean_square_s2_;
  return std::sqrt(mixed_s2 + deviation_s * deviation_s / information_);
}

void StampTrust::learn(double deviation_s, const MotionPrior& prior, const IcpResult& icp) {
  ++steps_;
  mean_square_s2_ += (deviation_s * deviation_s - mean_square_s2_) / steps_;

  Vector12d moved = Vector12d::Zero();  // more, if the whole deviation is motion
  moved.head<6>() = deviation_s * prior.state.twist_in_odom();
  // The sweep alone (information H) lies at x_s: (Λ + H) x = H x_s where the registration ended, x from the prior's
  // mean. The covariance of x_s about that mean is Λ⁻¹ + H⁻¹, whose inverse is Λ (Λ + H)⁻¹ H.
  const Matrix12d& H = icp.sweep_information;
  const Vector12d seen = (prior.information + H).ldlt().solve(prior.information * moved);
  const double information = seen.dot(H * moved);
  const double error = seen.dot(icp.posterior_information * prior_error(prior, icp.state));
  if (!(information > 0.0) || !std::isfinite(error)) {
    return;  // an even step, or nothing along the motion
  }
  const double total = information_ + information;
  share_ = (information_ * share_ + information * share() + error) / total;
  information_ = std::min(total, kMostInformation);
}

}  // namespace rilo
