#include "odometry/health.hpp"

#include "odometry/sweep_map.hpp"

namespace rilo {

bool is_degenerate(const IcpResult& icp, const HealthConfig& config, double unseen_share) {
  return icp.degeneracy.relative_eigenvalues[0] < (1.0 + unseen_share) * config.degenerate_ratio;
}

bool fits_map(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  if (icp.termination == IcpTermination::kSingular || evidence.shrunk || evidence.cut_off || evidence.ambiguous ||
      evidence.displaced) {
    return false;
  }
  if (!icp.converged() && icp.frozen) {
    return false;  // where a sweep belongs it comes to rest before its matches have to be held, or with them
  }
  if (evidence.second_sweep && (icp.frozen || is_degenerate(icp, config))) {
    return false;  // along a road with little to hold on to it fits metres off, too
  }
  const bool established = evidence.map_sweeps >= kEstablishedSweeps;
  if (!established && evidence.score * evidence.kept_share < config.least_score) {
    return false;
  }
  return evidence.score >= config.lost_share * evidence.usual_score;
}

OdometryStatus judge(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  if (!fits_map(icp, evidence, config) || !evidence.possible_motion) {
    return OdometryStatus::kLost;
  }
  if (evidence.was_lost) {
    return OdometryStatus::kRecovered;
  }
  if (is_degenerate(icp, config, evidence.unseen_share)) {
    return OdometryStatus::kDegenerate;
  }
  return OdometryStatus::kOk;
}

}  // namespace rilo
