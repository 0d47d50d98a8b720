#include "rilo/odometry/health.hpp"

namespace rilo {

OdometryStatus judge(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  const auto inliers = static_cast<double>(icp.inliers);
  const auto points = static_cast<double>(evidence.source_points);
  const bool unexplained = evidence.score < config.lost_share * evidence.usual_score;
  if (icp.iterations <= 1 && !icp.converged) {
    return OdometryStatus::kLost;  // no step could be taken: hardly any correspondence
  }
  if (unexplained) {
    return OdometryStatus::kLost;
  }
  if (inliers < config.few_inlier_ratio * points) {
    return OdometryStatus::kFewCorrespondences;
  }
  if (evidence.was_lost) {
    return OdometryStatus::kRecovered;
  }
  if (icp.degeneracy.relative_eigenvalues[0] < config.degenerate_ratio) {
    return OdometryStatus::kDegenerate;
  }
  return OdometryStatus::kOk;
}

}  // namespace rilo
