#include "rilo/odometry/health.hpp"

namespace rilo {

namespace {
constexpr double kYoungShare = 0.5;  // of the usual score, that a map of a few sweeps reaches
}

OdometryStatus judge(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  const auto inliers = static_cast<double>(icp.inliers);
  const auto points = static_cast<double>(evidence.source_points);
  const double expected = evidence.young_map ? kYoungShare * evidence.usual_score : evidence.usual_score;
  const bool unexplained = evidence.score < config.lost_share * expected;
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
