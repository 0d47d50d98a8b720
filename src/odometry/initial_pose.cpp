#include "rilo/odometry/initial_pose.hpp"

#include <utility>

#include "rilo/cloud/deskew.hpp"
#include "rilo/registration/map_score.hpp"

namespace rilo {

namespace {
constexpr double kLearningRate = 0.2;
constexpr double kDoubtfulLearningRate = 0.02;
// The search looks at fewer points and more tolerantly than the score: it only has to find the right valley.
constexpr std::size_t kSearchPoints = 300;
constexpr double kSearchSigmaM = 0.3;
constexpr double kSearchShiftStepM = 0.5;
constexpr double kSearchYawStepRad = 0.1;
constexpr std::size_t kSearchStarts = 4;
// A cloud compensated for a slightly wrong velocity is as good a target: at either end of a sweep of 0.1 s its points
// are off by less than the least noise of the coarse stage.
constexpr double kHalfSweepS = 0.05;
constexpr double kSameTurnRad = 0.005;
constexpr double kSameShiftM = 0.05;
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
    take_coarse = coarse.score > prediction.score + config.margin;
    choice.reason = take_coarse ? InitialPoseReason::kBetterMapScore : InitialPoseReason::kWorseMapScore;
  }
  choice.source = take_coarse ? InitialPoseSource::kCoarse : InitialPoseSource::kPrediction;
  choice.T_odom_lidar = take_coarse ? coarse.T_odom_lidar : prediction.T_odom_lidar;
  choice.prediction_score = prediction.score;
  return choice;
}

InitialPose InitialPoseStage::choose(const TimedCloud& source, const MotionState& predicted, const SE3& previous,
                                     double dt_s, const LocalMap& map, bool in_doubt,
                                     const std::function<bool()>& time_left) {
  const ScoredPose prediction{predicted.T_odom_lidar, score(source, predicted, map)};
  InitialPose choice;
  choice.T_odom_lidar = prediction.T_odom_lidar;
  choice.prediction_score = prediction.score;
  if (!coarse_.enabled) {
    choice.reason = InitialPoseReason::kCoarseDisabled;
    return choice;
  }
  const bool doubt = in_doubt || !explains(prediction.score);
  if (!doubt && !coarse_.always) {
    return choice;
  }
  if (time_left && !time_left()) {
    choice.coarse_cut = true;
    choice.reason = InitialPoseReason::kNoTime;
    return choice;
  }
  moving_ = distribution(compensated_);
  moving_twist_ = predicted.twist;
  if (!target_) {
    target_ = distribution(target_points_);
  }
  ScoredPose best{prediction.T_odom_lidar, -1.0};
  int iterations = 0;
  int starts = 0;
  bool cut = false;
  const auto try_from = [&](const SE3& start) {
    cut = cut || (starts > 0 && time_left && !time_left());
    if (cut) {
      return;
    }
    ++starts;
    const CoarseResult result = coarse_registration(*moving_, *target_, previous.inverse() * start, coarse_);
    iterations += result.iterations;
    // Each candidate implies its own motion during the sweep, and is judged on the sweep compensated for it.
    const MotionState state{previous * result.T_target_source, se3_log(result.T_target_source) / dt_s};
    const double value = score(source, state, map);
    if (value > best.score) {
      best = {state.T_odom_lidar, value};
    }
  };
  try_from(predicted.T_odom_lidar);
  if (doubt && !explains(best.score)) {
    try_from(previous);  // no motion
  }
  if (doubt && config_.restarts && !cut && !explains(best.score)) {
    deskew(source, predicted.twist, compensated_);
    for (const SE3& start : restarts(previous, map)) {
      try_from(start);
    }
  }
  choice = select_initial_pose(prediction, best, config_);
  choice.coarse_iterations = iterations;
  choice.coarse_starts = starts;
  choice.coarse_cut = cut;
  return choice;
}

bool InitialPoseStage::explains(double score) const {
  return usual_score_ > 0.0 && score >= config_.alarm * usual_score_;
}

std::vector<SE3> InitialPoseStage::restarts(const SE3& previous, const LocalMap& map) const {
  const PoseGrid grid{config_.search_shift_m, kSearchShiftStepM, config_.search_yaw_rad, kSearchYawStepRad};
  return search_poses(evenly_picked(compensated_, kSearchPoints), map, previous, grid, kSearchSigmaM, kSearchStarts);
}

double InitialPoseStage::score(const TimedCloud& source, const MotionState& state, const LocalMap& map) {
  deskew(source, state.twist, compensated_);
  const auto points = evenly_picked(compensated_, static_cast<std::size_t>(config_.score_points));
  return map_score(points, map, state.T_odom_lidar, config_.score_sigma_m);
}

void InitialPoseStage::learn(double score) {
  const double rate = explains(score) ? kLearningRate : kDoubtfulLearningRate;
  usual_score_ = usual_score_ > 0.0 ? usual_score_ + rate * (score - usual_score_) : score;
}

void InitialPoseStage::keep_target(const TimedCloud& source, const Vector6d& twist) {
  target_.reset();
  const Vector6d moved = kHalfSweepS * (twist - moving_twist_);
  if (moving_ && moved.head<3>().norm() < kSameTurnRad && moved.tail<3>().norm() < kSameShiftM) {
    target_ = std::move(moving_);
  } else {
    deskew(source, twist, target_points_);
  }
  moving_.reset();
}

void InitialPoseStage::reset() {
  usual_score_ = 0.0;
  forget_target();
}

void InitialPoseStage::forget_target() {
  target_points_.clear();
  target_.reset();
  moving_.reset();
}

DistributionCloud InitialPoseStage::distribution(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> sampled;
  for (const std::uint32_t i : sampler_.sample(points, coarse_.voxel_m)) {
    sampled.push_back(points[i]);
  }
  return make_distribution_cloud(evenly_picked(sampled, static_cast<std::size_t>(coarse_.max_points)), coarse_);
}

}  // namespace rilo
