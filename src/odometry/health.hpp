// How far a registration can be trusted.
#pragma once

#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// Evidence about one registration.
struct Evidence {
  double score = 0;             ///< map score at the registered pose
  double kept_share = 1;        ///< of the returns: the others, flakes, are not explained by the map
  double usual_score = 0;       ///< of the sweeps before; 0: unknown
  bool was_lost = false;        ///< the sweep before was lost
  std::size_t map_sweeps = 0;   ///< in the map: while they are few, it may itself be wrong
  bool covered = false;         ///< the place is much smaller than one sweep before, or one that moves along
  bool cut_off = false;         ///< the registration ran out of time far from its end
  bool possible_motion = true;  ///< a sensor can have moved to the pose
  /// It fits worse than sweeps that belong there do, or elsewhere as well; kNone: it does not.
  LossCause misplaced = LossCause::kNone;
  bool second_sweep = false;  ///< of the map: there is no usual score to judge it by
  double unseen_share = 0;    ///< of the sweeps before: those that were degenerate
};

/// Whether the sweep says too little in one direction. After sweeps of which a share did it must say more: what was put
/// together while a direction was not seen shows how it was put together, too.
bool is_degenerate(const IcpResult& icp, const HealthConfig& config, double unseen_share = 0.0);

/// Why a registered sweep is lost. kImpossibleMotion: its pose would be right if the motion to it were possible.
LossCause loss_cause(const IcpResult& icp, const Evidence& evidence, const HealthConfig& config);

/// Status of a registered sweep; `cause`: why it is lost, if it is.
OdometryStatus status_of(LossCause cause, const IcpResult& icp, const Evidence& evidence, const HealthConfig& config);

}  // namespace rilo
