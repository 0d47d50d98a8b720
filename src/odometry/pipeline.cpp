#include "odometry/pipeline.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "cloud/thinning.hpp"
#include "odometry/motion_prior.hpp"
#include "odometry/registration_stage.hpp"
#include "odometry/sweep_record.hpp"

namespace rilo {

namespace {
constexpr double kCoarseShare = 0.5;  // of the time left; the rest is for what follows the coarse stage
constexpr double kGapPeriods = 3.5;   // over two missing sweeps the prediction still leads to the basin
constexpr double kLeastCoarse = 0.3;  // of its points; with fewer it finds nothing

void check_column(const char* name, std::size_t values, std::size_t points) {
  if (values == 0 || values == points) return;
  throw std::invalid_argument(std::string(name) + ": " + std::to_string(values) + " values for " +
                              std::to_string(points) + " points; expected none, or one for each");
}

/// A column that is dropped because one value is missing costs the motion compensation.
void check_columns(const SweepView& sweep) {
  check_column("times_s", sweep.times_s.size(), sweep.points.size());
  check_column("intensities", sweep.intensities.size(), sweep.points.size());
  check_column("rings", sweep.rings.size(), sweep.points.size());
}
}  // namespace

Pipeline::Pipeline(const OdometryConfig& config, Odometry::Clock clock)
    : config_(validated(config)),
      clock_(std::move(clock)),
      workers_(config.threads),
      arena_(config.threads > 0 ? config.threads : tbb::task_arena::automatic),
      budget_(config.budget, config.preprocess.source_points),
      preprocessor_(config.preprocess),
      tracker_(config.prediction, config.prior, config.bounds),
      initial_pose_(config.initial_pose, config.coarse),
      judge_(config.health),
      threshold_(config.threshold),
      calibration_(config.elevation, config.beams),
      map_(config.map) {
  if (budget_.limited() && !clock_) {
    throw std::invalid_argument("configuration: budget.sweep_ms is set, but the odometry was given no clock");
  }
  calibration_.apply_to(preprocessor_);
}

SweepResult Pipeline::register_sweep(const SweepView& sweep) {
  check_columns(sweep);
  SweepResult result;
  arena_.execute([&] { process(sweep, result); });
  return result;
}

void Pipeline::process(const SweepView& sweep, SweepResult& result) {
  const PreparedSweep& prepared = prepare(sweep, result);
  if (prepared.source.points.empty() || repeated_) {
    result.status = OdometryStatus::kEmpty;
    result.covariance = guess_covariance();
    if (map_.sweeps() > 0) {
      // A simulated sensor without noise, at rest, sees the sweep before again.
      const MotionState at_rest{tracker_.state().T_odom_lidar, Vector6d::Zero()};
      lose(prepared, repeated_ ? at_rest : predict(prepared).steady(), std::nullopt, result);
    }
  } else if (map_.sweeps() == 0) {
    begin_map(prepared, {}, result);
  } else {
    register_to_map(prepared, result);
  }
  result.stats.times.map_ms = clock_.lap_ms();
  finish(result);
}

void Pipeline::register_to_map(const PreparedSweep& prepared, SweepResult& result) {
  map_.map().set_scene_range(prepared.scene_range_m);
  const MotionState predicted = predict(prepared);                                 // III-B
  const InitialPose init = choose_initial_pose(prepared, predicted, result);       // III-A, III-B
  Registration registration = register_finely(prepared, predicted, init, result);  // III-D
  const Judgement judgement = judge(prepared, registration, result);               // before anything is learnt
  if (judgement.status != OdometryStatus::kLost) {
    accept(prepared, std::move(registration), judgement.motion, result);  // III-C, local map
  } else if (judgement.fits_map()) {
    lose(prepared, predicted.steady(), registration.icp.state.T_odom_lidar, result);
  } else {
    // What a second sweep found is not certain enough to vouch for; at rest, where it is predicted, it is less likely,
    // unless little of it fits: part of a first sweep draws it anywhere.
    const bool found = map_.sweeps() == 1 && registration.icp.converged() &&
                       judgement.motion != MotionVerdict::kImpossible &&
                       registration.score >= config_.health.lost_share * initial_pose_.expected_score();
    lose(prepared, found ? registration.icp.state : predicted.steady(), std::nullopt, result);
  }
}

const PreparedSweep& Pipeline::prepare(const SweepView& sweep, SweepResult& result) {
  clock_.begin();
  const bool first = map_.sweeps() == 0;
  shares_ = budget_.affordable(sweep.points.size(), first, in_doubt());
  result.stats.points_cut = shares_.cut();
  if (budget_.limited()) {
    preprocessor_.set_source_points(shares_.source * static_cast<double>(config_.preprocess.source_points));
  }
  const SweepView taken = shares_.raw < 1.0 ? thinned(sweep, shares_.raw, thinned_) : sweep;
  const PreparedSweep& prepared = preprocessor_.prepare(taken);
  record(sweep, prepared, result.stats);
  if (shares_.source < 1.0) {
    // The voxel follows from sweep to sweep, the time does not wait.
    const double wanted = shares_.source * static_cast<double>(config_.preprocess.source_points);
    thin(prepared, wanted / static_cast<double>(std::max<std::size_t>(prepared.source.size(), 1)), result.stats);
  }
  result.stats.times.preprocess_ms = clock_.lap_ms();
  const double passes = first ? Preprocessor::kFirstPasses : 1.0;
  budget_.learn(Work::kPrepare, passes * static_cast<double>(taken.points.size()), result.stats.times.preprocess_ms);
  const SweepTime time = sweep_clock_.advance(prepared.mid_stamp_ns, prepared.mid_stamp_ns - sweep.stamp_ns);
  result.stamp_ns = time.stamp_ns;
  tracker_.advance(time);
  const Fingerprint before = std::exchange(fingerprint_, Fingerprint(sweep.points));
  repeated_ = fingerprint_ == before;
  return prepared;
}

MotionState Pipeline::predict(const PreparedSweep& prepared) {
  MotionState predicted = tracker_.predicted(threshold_.sigma_th_m());
  const std::optional<MotionState> claimed = tracker_.predicted_from_claim();
  if (claimed && initial_pose_.score(prepared.source, *claimed, map_.map()) >
                     initial_pose_.score(prepared.source, predicted, map_.map())) {
    return *claimed;
  }
  return predicted;
}

InitialPose Pipeline::choose_initial_pose(const PreparedSweep& prepared, const MotionState& predicted,
                                          SweepResult& result) {
  const std::function<Vector6d(const SE3&)> twist_at = [&](const SE3& T) { return tracker_.implied_twist(T); };
  const double left_ms = kCoarseShare * (budget_.target_ms() - clock_.total_ms());
  const double coarse_share = std::max(kLeastCoarse, budget_.share_in_time(budget_.ms(Work::kCoarseStart), left_ms));
  InitialPose init =
      initial_pose_.choose({prepared.source, predicted, tracker_.trusted().T_odom_lidar, twist_at, map_.map(),
                            map_.first_can_be_compensated(), in_doubt() && !tracker_.begun_moving(), reach(),
                            deadline(0.0).after(kCoarseShare), coarse_share});
  record(init, result.stats);
  result.stats.times.initial_pose_ms = clock_.lap_ms();
  if (!init.coarse_cut) {
    budget_.learn(Work::kCoarseStart, init.coarse_starts * coarse_share, result.stats.times.initial_pose_ms);
  }
  if (init.coarse_starts > 0) {
    result.stats.points_cut = result.stats.points_cut || coarse_share < 1.0;
    const double rest_ms = shares_.source * budget_.ms(Work::kRest);
    thin(prepared, budget_.share_in_time(rest_ms, budget_.target_ms() - clock_.total_ms()), result.stats);
  }
  return init;
}

RegistrationContext Pipeline::registration_context(const PreparedSweep& prepared) {
  const auto map_points = static_cast<double>(prepared.map_cloud.size());
  return {.config = config_,
          .prepared = prepared,
          .tracker = tracker_,
          .map = map_,
          .initial_pose = initial_pose_,
          .pose_by_elevation = calibration_.pose_by_elevation(),
          .sigma_th_m = threshold_.sigma_th_m(),
          .usual_sigma_th_m = threshold_.usual_sigma_th_m(),
          .period_s = period_s(),
          .after_gap = after_gap(),
          .contradicted = contradicted_,
          .deadline = deadline(budget_.ms(Work::kSettle) + budget_.ms(Work::kInsert, map_points)),
          .first_map_ms = budget_.ms(Work::kInsert, static_cast<double>(map_.first_cloud().size()) + map_points)};
}

Registration Pipeline::register_finely(const PreparedSweep& prepared, const MotionState& predicted,
                                       const InitialPose& init, SweepResult& result) {
  result.stats.sigma_th_m = threshold_.sigma_th_m();
  if (map_.sweeps() == 1 && shares_.source < 1.0) {
    // Its second sweep compensates the first one again and again.
    const auto first_points = static_cast<double>(map_.first_cloud().size());
    map_.thin_first(std::min(1.0, static_cast<double>(prepared.map_cloud.size()) / first_points));
  }
  Registration registration = fine_registration(registration_context(prepared), predicted, init);
  const IcpResult& icp = registration.icp;
  const bool new_first_map = registration.first && registration.first->map;
  registration.stands_out =
      initial_pose_.stands_out(prepared.source, icp.state, new_first_map ? *registration.first->map : map_.map());
  record(icp, result.stats);
  result.stats.coarse_cut = result.stats.coarse_cut || registration.cut;
  if (in_doubt()) {
    budget_.learn_doubt(icp.termination == IcpTermination::kTimeLimit);
  }
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  result.translation_evidence = R.transpose() * icp.degeneracy.translation_evidence() * R;
  result.stats.times.registration_ms = clock_.lap_ms();
  return registration;
}

Judgement Pipeline::judge(const PreparedSweep& prepared, const Registration& registration, SweepResult& result) {
  const MotionState& state = registration.icp.state;
  const MotionVerdict motion = tracker_.weigh(state);
  const Judgement judgement =
      judge_.judge(prepared, registration, motion,
                   {map_.sweeps(), initial_pose_.expected_score(), initial_pose_.usual_quality(), tracker_.lost(),
                    after_gap(), tracker_.stayed(state.T_odom_lidar)});
  result.stats.map_score = registration.score;
  result.stats.loss_cause = judgement.cause;
  result.stats.impossible_motion = judgement.fits_map() && judgement.motion != MotionVerdict::kPossible;
  result.status = judgement.status;
  return judgement;
}

void Pipeline::finish(SweepResult& result) {
  result.T_odom_lidar = tracker_.state().T_odom_lidar;
  const BodyMotion motion = tracker_.state().motion();
  result.twist = motion.twist;
  result.acceleration = motion.acceleration;
  result.stats.map_voxels = map_.map().size();
  record(calibration_, result.stats);
  trajectory_.push_back({result.stamp_ns, result.T_odom_lidar});
  result.stats.times.total_ms = clock_.total_ms();
  if (budget_.limited()) {
    result.stats.over_budget = result.stats.times.total_ms > config_.budget.sweep_ms;
  }
}

void Pipeline::reset(const std::optional<SensorAngles>& known) {
  calibration_.reset();
  if (known) {
    calibration_.begin_with(*known);
  }
  start_over(std::nullopt);
}

double Pipeline::start_over(const std::optional<KnownVelocity>& velocity) {
  budget_.reset();
  preprocessor_.reset();
  sweep_clock_.reset();
  tracker_.reset(velocity);
  initial_pose_.reset();
  judge_.reset();
  threshold_.reset();
  pose_covariance_.reset();
  calibration_.start_over();
  calibration_.apply_to(preprocessor_);
  map_.clear();
  trajectory_.clear();
  fingerprint_ = {};
  contradicted_ = false;
  shares_ = {};
  last_step_.setZero();
  return calibration_.elevation().applied_rad();
}

double Pipeline::period_s() const { return static_cast<double>(sweep_clock_.period_ns()) * 1e-9; }

double Pipeline::periods_since_trusted() const { return tracker_.since_trusted_s() / period_s(); }

bool Pipeline::after_gap() const { return periods_since_trusted() - judge_.lost_in_a_row() > kGapPeriods; }

std::optional<Reach> Pipeline::reach() const {
  // Where a sweep was not found there, it may lie elsewhere: the clock may have been set forward.
  const bool known = established() && !tracker_.lost();
  return known && after_gap() ? std::optional(tracker_.reach()) : std::nullopt;
}

bool Pipeline::in_doubt() const { return !established() || tracker_.lost(); }

bool Pipeline::established() const { return map_.sweeps() >= kEstablishedSweeps; }

}  // namespace rilo
