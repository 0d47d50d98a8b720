#include "rilo/odometry/initial_pose.hpp"

#include <algorithm>
#include <cmath>
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
// A sweep whose score over its residuals is below this share of the usual ratio may have been taken at another time
// than its stamp says: so many periods earlier or later, looked for in steps of at most these.
constexpr double kSuspicious = 0.8;
constexpr double kPeriodsEarlier = 2.0;
constexpr double kPeriodsLater = 12.0;
constexpr double kPathStepM = 0.3;
constexpr double kPathStepRad = 0.05;
constexpr double kMostPathSteps = 100.0;
constexpr std::size_t kPathPlaces = 3;
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
    take_coarse = coarse.score > (1.0 + config.margin) * prediction.score;
    choice.reason = take_coarse ? InitialPoseReason::kBetterMapScore : InitialPoseReason::kWorseMapScore;
  }
  choice.source = take_coarse ? InitialPoseSource::kCoarse : InitialPoseSource::kPrediction;
  choice.T_odom_lidar = take_coarse ? coarse.T_odom_lidar : prediction.T_odom_lidar;
  choice.prediction_score = prediction.score;
  return choice;
}

// One decision, step by step.
// NOLINTNEXTLINE(readability-function-size)
InitialPose InitialPoseStage::choose(const TimedCloud& source, const MotionState& predicted, const SE3& previous,
                                     const std::function<Vector6d(const SE3&)>& twist_at, const LocalMap& map,
                                     bool single, bool in_doubt, const std::function<bool()>& time_left) {
  ScoredPose prediction{predicted.T_odom_lidar, score(source, predicted, map)};
  if (single) {
    // All points: the candidates differ by few of them.
    prediction.score = map_score(compensated_, map, predicted.T_odom_lidar, config_.score_sigma_m);
  }
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
  const auto consider = [&](const SE3& T) {
    double value = 0.0;
    if (single) {
      deskew(source, predicted.twist, compensated_);
      value = map_score(compensated_, map, T, config_.score_sigma_m);
    } else {
      // Each candidate implies its own motion during the sweep, and is judged on the sweep compensated for it.
      value = score(source, {T, twist_at(T)}, map);
    }
    if (value > best.score) {
      best = {T, value};
    }
  };
  const auto try_from = [&](const SE3& start) {
    cut = cut || (starts > 0 && time_left && !time_left());
    if (cut) {
      return;
    }
    ++starts;
    const CoarseResult result = coarse_registration(*moving_, *target_, previous.inverse() * start, coarse_);
    iterations += result.iterations;
    consider(previous * result.T_target_source);
  };
  try_from(prediction.T_odom_lidar);
  if (doubt && !explains(best.score)) {
    try_from(previous);  // no motion
  }
  if (doubt && config_.restarts && !cut && !explains(best.score)) {
    deskew(source, predicted.twist, compensated_);
    for (const SE3& start : restarts(prediction.T_odom_lidar, map)) {
      try_from(start);
      if (single) {
        consider(start);
      }
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

bool InitialPoseStage::suspicious(double score, double residual_rms_m) const {
  return usual_score_ > 0.0 && score * usual_rms_m_ < kSuspicious * usual_score_ * residual_rms_m;
}

std::vector<SE3> InitialPoseStage::places_on_path(const TimedCloud& source, const MotionState& predicted, double dt_s,
                                                  const LocalMap& map) {
  const Vector6d period = dt_s * predicted.twist;
  const double steps_a_period =
      std::ceil(std::max(period.tail<3>().norm() / kPathStepM, period.head<3>().norm() / kPathStepRad));
  const auto steps =
      static_cast<std::size_t>(std::min(steps_a_period * (kPeriodsEarlier + kPeriodsLater), kMostPathSteps));
  const double step = steps > 0 ? (kPeriodsEarlier + kPeriodsLater) / static_cast<double>(steps) : 0.0;
  deskew(source, predicted.twist, compensated_);
  const auto points = evenly_picked(compensated_, kSearchPoints);
  std::vector<ScoredPose> path;
  for (std::size_t k = 0; k <= steps; ++k) {
    const SE3 T = predicted.T_odom_lidar * se3_exp((static_cast<double>(k) * step - kPeriodsEarlier) * period);
    path.push_back({T, map_score(points, map, T, kSearchSigmaM)});
  }
  std::vector<ScoredPose> maxima;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const bool rises = k == 0 || path[k].score > path[k - 1].score;
    const bool falls = k + 1 == path.size() || path[k].score >= path[k + 1].score;
    if (rises && falls) {
      maxima.push_back(path[k]);
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  std::vector<SE3> places;
  for (std::size_t i = 0; i < std::min(maxima.size(), kPathPlaces); ++i) {
    places.push_back(maxima[i].T_odom_lidar);
  }
  return places;
}

std::vector<SE3> InitialPoseStage::restarts(const SE3& centre, const LocalMap& map) const {
  const PoseGrid grid{config_.search_shift_m, kSearchShiftStepM, config_.search_yaw_rad, kSearchYawStepRad};
  return search_poses(compensated_, map, centre, grid, kSearchSigmaM, kSearchStarts);
}

double InitialPoseStage::score(const TimedCloud& source, const MotionState& state, const LocalMap& map) {
  deskew(source, state.twist, compensated_);
  const auto points = evenly_picked(compensated_, static_cast<std::size_t>(config_.score_points));
  return map_score(points, map, state.T_odom_lidar, config_.score_sigma_m);
}

void InitialPoseStage::learn(double score, double residual_rms_m) {
  const double rate = explains(score) ? kLearningRate : kDoubtfulLearningRate;
  const bool first = !(usual_score_ > 0.0);
  usual_score_ = first ? score : usual_score_ + rate * (score - usual_score_);
  usual_rms_m_ = first ? residual_rms_m : usual_rms_m_ + rate * (residual_rms_m - usual_rms_m_);
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

void InitialPoseStage::begin(const TimedCloud& source, const MotionState& state, const LocalMap& map) {
  reset();
  own_score_ = score(source, state, map);
  keep_target(source, state.twist);
}

void InitialPoseStage::reset() {
  usual_score_ = 0.0;
  usual_rms_m_ = 0.0;
  own_score_ = 0.0;
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
