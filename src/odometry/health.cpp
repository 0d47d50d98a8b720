#include "odometry/health.hpp"

#include "odometry/sweep_map.hpp"

namespace rilo {

bool is_degenerate(const IcpResult& icp, const HealthConfig& config, double unseen_share) {
  return icp.degeneracy.relative_eigenvalues[0] < (1.0 + unseen_share) * config.degenerate_ratio;
}

LossCause loss_cause(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  if (evidence.covered) return LossCause::kCovered;
  if (icp.termination == IcpTermination::kSingular) return LossCause::kUnsolved;
  if (evidence.cut_off) return LossCause::kOutOfTime;
  if (evidence.misplaced != LossCause::kNone) return evidence.misplaced;
  // Where a sweep belongs it comes to rest before its matches have to be held, or with them.
  if (!icp.converged() && icp.frozen) return LossCause::kNotConverged;
  // Along a road with little to hold on to it fits metres off, too.
  if (evidence.second_sweep && (icp.frozen || is_degenerate(icp, config))) return LossCause::kWeakSecondSweep;
  const bool established = evidence.map_sweeps >= kEstablishedSweeps;
  if ((!established && evidence.score * evidence.kept_share < config.least_score) ||
      evidence.score < config.lost_share * evidence.usual_score) {
    return LossCause::kLowScore;
  }
  return evidence.possible_motion ? LossCause::kNone : LossCause::kImpossibleMotion;
}

OdometryStatus status_of(LossCause cause, const IcpResult& icp, const Evidence& evidence, const HealthConfig& config) {
  if (cause != LossCause::kNone) {
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
