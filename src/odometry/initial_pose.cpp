#include "odometry/initial_pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cloud/deskew.hpp"
#include "cloud/thinning.hpp"
#include "odometry/optimum.hpp"
#include "odometry/pose_noise.hpp"
#include "odometry/running_mean.hpp"
#include "registration/map_score.hpp"
#include "registration/pose_grid.hpp"

namespace rilo {

namespace {
constexpr double kDoubtfulShare = 0.02;  // of a score below the alarm in the usual one
// What a coarse result of the second sweep reaches of the score of the first one on its own map where it is right: 0.83
// to 1.14. Wrong ones reach it along a road, where other starts follow.
constexpr double kOwnShare = 0.8;
constexpr std::size_t kManyPoints = 5000;  // where few of them make the difference
constexpr double kSearchSigmaM = 0.3;      // more tolerant than the score: it only has to find the basin
constexpr double kSearchStepM = 0.5;       // within the reach of the coarse stage
constexpr double kSearchStepRad = 0.1;
constexpr double kReachSigmas = 1.5;      // of the motion in a gap: each way costs time (experiment: long gaps)
constexpr double kMostShiftM = 10.0;      // half a second on one thread
constexpr double kSearchShare = 0.6;      // of the time left; the coarse stage from what was found needs the rest
constexpr std::size_t kSearchStarts = 4;  // the cost of each is one registration
// A cloud compensated for a slightly wrong velocity serves as a target: at either end of a sweep of 0.1 s it is off by
// less than good poses are.
constexpr double kHalfSweepS = 0.05;
}  // namespace

InitialPose select_initial_pose(const ScoredPose& prediction, const ScoredPose& coarse,
                                const InitialPoseConfig& config) {
  InitialPose choice;
  const SE3 difference = prediction.T_odom_lidar.inverse() * coarse.T_odom_lidar;
  choice.pred_align_distance_m = difference.translation().norm();  // Δt_i
  bool take_coarse = false;
  if (config.rule == InitialPoseRule::kFixedTau) {
    take_coarse = choice.pred_align_distance_m <= config.tau_m;
    choice.reason = take_coarse ? InitialPoseReason::kWithinTau : InitialPoseReason::kBeyondTau;
  } else {
    take_coarse = coarse.score > (1.0 + config.margin) * prediction.score;
    choice.reason = take_coarse ? InitialPoseReason::kBetterMapScore : InitialPoseReason::kWorseMapScore;
  }
  choice.source = take_coarse ? InitialPoseSource::kCoarse : InitialPoseSource::kPrediction;
  choice.T_odom_lidar = take_coarse ? coarse.T_odom_lidar : prediction.T_odom_lidar;
  choice.prediction_score = prediction.score;
  return choice;
}

InitialPose InitialPoseStage::choose(const Situation& situation) {
  moving_.reset();
  const MotionState& predicted = situation.predicted;
  const ScoredPose prediction{predicted.T_odom_lidar,
                              candidate_score(situation, predicted.T_odom_lidar, predicted.twist)};
  InitialPose choice;
  choice.T_odom_lidar = prediction.T_odom_lidar;
  choice.prediction_score = prediction.score;
  if (!coarse_.enabled) {
    choice.reason = InitialPoseReason::kCoarseDisabled;
    return choice;
  }
  const bool doubt = situation.in_doubt || !is_consistent(prediction.score);
  if (!doubt && !coarse_.always) {
    return choice;
  }
  if (situation.deadline.passed()) {
    choice.coarse_cut = true;
    choice.reason = InitialPoseReason::kNoTime;
    return choice;
  }
  const Search found = search(situation, doubt);
  if (found.best.score >= 0.0) {
    choice = select_initial_pose(prediction, found.best, config_);
  } else {
    choice.reason = InitialPoseReason::kWorseMapScore;  // nothing that was found can be
  }
  choice.coarse_iterations = found.iterations;
  choice.coarse_starts = found.starts;
  choice.coarse_cut = found.cut;
  return choice;
}

InitialPoseStage::Search InitialPoseStage::search(const Situation& situation, bool doubt) {
  const MotionState& predicted = situation.predicted;
  deskew(situation.source, predicted.motion(), compensated_);
  moving_ = distribution(compensated_, situation.coarse_share);
  moving_twist_ = predicted.twist;
  if (!target_) {
    deskew(target_source_, {target_twist_}, compensated_);
    target_ = distribution(compensated_, situation.coarse_share);
  }
  Search found;
  found.best = {predicted.T_odom_lidar, -1.0};
  const bool resumed = std::exchange(restarts_due_, false);
  if (!resumed) {
    try_from(situation, predicted.T_odom_lidar, found);
    // From rest; after a gap, which a sensor at speed does not spend at rest, from where its turn has faded.
    const SE3& other = situation.reach ? situation.reach->T_odom_centre : situation.previous;
    if (doubt && !predicted.T_odom_lidar.isApprox(other) && !is_consistent(found.best.score)) {
      try_from(situation, other, found);
    }
    restarts_due_ = doubt && config_.restarts && found.cut;
  }
  if (doubt && config_.restarts && !found.cut && !is_consistent(found.best.score)) {
    deskew(situation.source, {predicted.twist}, compensated_);
    for (const SE3& start : restarts(situation)) {
      if (is_consistent(found.best.score)) {
        break;
      }
      try_from(situation, start, found);
      if (situation.single || resumed) {
        consider(situation, start, found.best);
      }
    }
  }
  return found;
}

void InitialPoseStage::try_from(const Situation& situation, const SE3& start, Search& search) {
  search.cut = search.cut || (search.starts > 0 && situation.deadline.passed());
  if (search.cut) {
    return;
  }
  ++search.starts;
  const CoarseResult result =
      coarse_registration(*moving_, *target_, situation.previous.inverse() * start, coarse_, situation.deadline);
  search.cut = result.cut;
  search.iterations += result.iterations;
  consider(situation, situation.previous * result.T_target_source, search.best);
}

void InitialPoseStage::consider(const Situation& situation, const SE3& T, ScoredPose& best) {
  if (situation.reach && !situation.reach->contains(T)) {
    return;  // a road looks the same where the sensor was before
  }
  // Each candidate implies its own motion during the sweep.
  const Vector6d twist = situation.single ? situation.predicted.twist : situation.twist_at(T);
  const double value = candidate_score(situation, T, twist);
  if (value > best.score) {
    best = {T, value};
  }
}

double InitialPoseStage::candidate_score(const Situation& situation, const SE3& T, const Vector6d& twist) const {
  if (!situation.single) {
    return score(situation.source, {T, twist}, situation.map);
  }
  return map_score(deskew_picked(situation.source, {twist}, kManyPoints), situation.map, T, config_.score_sigma_m);
}

bool InitialPoseStage::is_consistent(double score) const {
  return usual_score_ > 0.0 ? score >= config_.alarm * usual_score_
                            : own_score_ > 0.0 && score >= kOwnShare * own_score_;
}

bool InitialPoseStage::suspicious(double quality) const { return rilo::suspicious(quality, usual_quality_); }

std::vector<SE3> InitialPoseStage::restarts(const Situation& situation) const {
  PoseGrid grid{config_.search_shift_m, kSearchStepM, config_.search_yaw_rad, kSearchStepRad};
  SE3 centre = situation.predicted.T_odom_lidar;
  if (situation.reach) {
    const Reach& reach = *situation.reach;
    centre = reach.T_odom_centre;
    grid.max_shift_m = std::max(grid.max_shift_m, std::min(kReachSigmas * reach.sigma_m, kMostShiftM));
    grid.max_yaw_rad = std::max(grid.max_yaw_rad, std::min(kReachSigmas * reach.sigma_rad, std::numbers::pi));
  }
  return search_poses(compensated_, situation.map, centre, grid, kSearchSigmaM, kSearchStarts,
                      situation.deadline.after(kSearchShare));
}

double InitialPoseStage::score(const TimedCloud& source, const MotionState& state, const LocalMap& map) const {
  const auto points = deskew_picked(source, state.motion(), static_cast<std::size_t>(config_.score_points));
  return map_score(points, map, state.T_odom_lidar, config_.score_sigma_m);
}

bool InitialPoseStage::stands_out(const TimedCloud& source, const MotionState& state, const LocalMap& map) const {
  const auto with_points = [&](std::size_t count) {
    const auto points = deskew_picked(source, state.motion(), count);
    return rilo::stands_out(points, map, state.T_odom_lidar, config_.score_sigma_m);
  };
  return with_points(static_cast<std::size_t>(config_.score_points)) || with_points(kManyPoints);
}

void InitialPoseStage::learn(double score, std::optional<double> quality) {
  const double share = is_consistent(score) ? kRunningShare : kDoubtfulShare;
  follow(usual_score_, score, share);
  if (quality) {
    follow(usual_quality_, *quality, share);
  }
}

void InitialPoseStage::keep_target(const TimedCloud& source, const Vector6d& twist) {
  restarts_due_ = false;
  target_.reset();
  const Vector6d moved = kHalfSweepS * (twist - moving_twist_);
  if (moving_ && within_pose_noise(moved)) {
    target_ = std::move(moving_);
  }
  target_source_.points = source.points;
  target_source_.offsets_s = source.offsets_s;
  target_twist_ = twist;
  moving_.reset();
}

void InitialPoseStage::begin(const TimedCloud& source, const MotionState& state, const LocalMap& map) {
  reset();
  own_score_ = score(source, state, map);
  keep_target(source, state.twist);
}

void InitialPoseStage::reset() { *this = InitialPoseStage(config_, coarse_); }

DistributionCloud InitialPoseStage::distribution(const std::vector<Eigen::Vector3f>& points, double share) {
  std::vector<Eigen::Vector3f> sampled;
  for (const std::uint32_t i : sampler_.sample(points, coarse_.voxel_m)) {
    sampled.push_back(points[i]);
  }
  return make_distribution_cloud(evenly_picked(sampled, static_cast<std::size_t>(share * coarse_.max_points)), coarse_);
}

}  // namespace rilo
