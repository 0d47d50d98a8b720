#include "odometry/sweep_judge.hpp"

#include <algorithm>

#include "odometry/health.hpp"
#include "odometry/optimum.hpp"
#include "odometry/pose_noise.hpp"
#include "odometry/running_mean.hpp"

namespace rilo {

namespace {
constexpr int kMostBeginnings = 10;           // a robot may start where the place shows no better second sweep
constexpr double kShrunk = 1.0 / 3.0;         // of the last median range: doors and passing lorries take less at once
constexpr double kFitsWorse = 0.9;            // of the usual quality: right sweeps hardly ever fit that much worse
constexpr double kFitsMuchWorse = 1.0 / 3.0;  // of the usual quality: most such sweeps are wrong, whatever they see
constexpr double kFoundAgain = 0.7;           // of the usual score: below it most places that a search finds are wrong
constexpr double kSeesLess = 0.25;  // of the usual least eigenvalue: right sweeps that fit worse hardly ever do
constexpr double kClose = 2.0;  // times the usual residuals, or a share of the usual quality (experiment: long gaps)
constexpr double kUnseenGain = 0.05;  // of one sweep in the share of degenerate ones
constexpr int kTriesAfterGap = 3;     // each takes a search; few sweeps that the first ones did not place fit later
/// Out of time while the points still moved by more than that: each update leaves about as much as it was. (With 0.03 m
/// hardly a second sweep is found in 25 ms, with 0.3 m wrong ones are.)
bool cut_off(const IcpResult& icp, double range_m) {
  return icp.termination == IcpTermination::kTimeLimit &&
         icp.last_update.tail<3>().norm() + range_m * icp.last_update.head<3>().norm() > kPoseNoiseM;
}
}  // namespace

Judgement SweepJudge::judge(const PreparedSweep& prepared, const Registration& registration, MotionVerdict motion,
                            const JudgedAgainst& before) const {
  const View view = view_of(registration, before);
  if (motion == MotionVerdict::kImpossible && before.usual_quality > 0.0 && !view.degenerate &&
      settled(registration.icp) && !suspicious(registration.quality, before.usual_quality)) {
    motion = MotionVerdict::kJump;  // the time is less certain than that: sweeps are missing, or come at uneven times
  }
  Evidence evidence;
  evidence.score = registration.score;
  evidence.kept_share = prepared.kept_share();
  evidence.second_sweep = before.map_sweeps == 1 && begun_in_a_row_ <= kMostBeginnings;
  evidence.misplaced = misplaced(registration, view, motion, before);
  evidence.map_sweeps = before.map_sweeps;
  evidence.usual_score = view.map_may_end ? 0.0 : before.usual_score;
  evidence.was_lost = before.was_lost;
  evidence.unseen_share = unseen_share_;
  // A cover moves along with the sensor: a map of it shows no motion.
  const bool moves_along = begun_covered_ && before.map_sweeps == 1 && before.stayed;
  evidence.covered = moves_along || prepared.median_range_m < kShrunk * median_range_m_;
  evidence.cut_off = cut_off(registration.icp, prepared.median_range_m);
  evidence.possible_motion = motion != MotionVerdict::kImpossible;
  const LossCause cause = loss_cause(registration.icp, evidence, config_);
  return {status_of(cause, registration.icp, evidence, config_), motion, cause};
}

SweepJudge::View SweepJudge::view_of(const Registration& registration, const JudgedAgainst& before) const {
  View view;
  view.degenerate = is_degenerate(registration.icp, config_);
  view.less = registration.icp.degeneracy.relative_eigenvalues[0] < kSeesLess * usual_eigenvalue_;
  view.after_gap = before.after_gap && usual_residual_m_ > 0.0;
  // What counts there is how closely the sweep fits, not how much of it, as long as it shows all directions about as
  // usual.
  view.map_may_end = view.after_gap && !view.less && !view.degenerate;
  return view;
}

LossCause SweepJudge::misplaced(const Registration& registration, const View& view, MotionVerdict motion,
                                const JudgedAgainst& before) const {
  if (registration.ambiguous) return LossCause::kAmbiguous;
  // After a loss a place that has changed must be taken as it is; so must one that shows a direction no longer.
  const double least_quality = (view.less ? kFitsWorse : kFitsMuchWorse) * before.usual_quality;
  if (!view.map_may_end && !before.was_lost && !view.degenerate && registration.quality < least_quality) {
    return LossCause::kFitsWorse;
  }
  // A search looks at so many places that one of them fits by chance; that two sweeps agree on one is none, nor is the
  // place where the sensor was.
  if (!view.map_may_end && before.was_lost && !before.stayed && motion != MotionVerdict::kJump &&
      registration.score < kFoundAgain * before.usual_score) {
    return LossCause::kFoundByChance;
  }
  if (!registration.stands_out) return LossCause::kFitsBeside;
  const bool closely = !view.after_gap || fits_closely(registration, before.usual_quality);
  return closely ? LossCause::kNone : LossCause::kLooseAfterGap;
}

/// Hardly a wrong sweep comes to rest with residuals like those of right ones; one whose matches had to be held has to
/// fit in both.
bool SweepJudge::fits_closely(const Registration& registration, double usual_quality) const {
  return settled(registration.icp) ? registration.icp.residual_rms_m <= kClose * usual_residual_m_
                                   : registration.quality >= usual_quality / kClose;
}

bool SweepJudge::give_up(bool established, double since_last, LossCause cause) {
  ++lost_in_a_row_;
  if (cause != LossCause::kCovered) ++tried_in_a_row_;
  const bool long_ago = since_last >= config_.restart_after && tried_in_a_row_ >= kTriesAfterGap;
  return !established || long_ago || lost_in_a_row_ >= config_.restart_after;
}

void SweepJudge::begin(const PreparedSweep& prepared, bool covered) {
  const bool still = begun_covered_ && begun_in_a_row_ > 0 && kShrunk * prepared.median_range_m < median_range_m_;
  begun_covered_ = covered || still;
  median_range_m_ = prepared.median_range_m;
  usual_eigenvalue_ = 0.0;
  usual_residual_m_ = 0.0;
  unseen_share_ = 0.0;
  lost_in_a_row_ = tried_in_a_row_ = 0;
  ++begun_in_a_row_;
}

void SweepJudge::accept(const PreparedSweep& prepared, const Registration& registration, bool degenerate) {
  median_range_m_ = prepared.median_range_m;
  follow(usual_eigenvalue_, registration.icp.degeneracy.relative_eigenvalues[0]);
  follow(usual_residual_m_, registration.icp.residual_rms_m);
  unseen_share_ += kUnseenGain * ((degenerate ? 1.0 : 0.0) - unseen_share_);
  lost_in_a_row_ = tried_in_a_row_ = 0;
  begun_in_a_row_ = 0;
}

}  // namespace rilo
