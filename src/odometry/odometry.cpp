#include "rilo/odometry/odometry.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "cloud/fingerprint.hpp"
#include "odometry/motion_tracker.hpp"
#include "odometry/pose_covariance.hpp"
#include "odometry/stage_clock.hpp"
#include "odometry/sweep_clock.hpp"
#include "odometry/sweep_map.hpp"
#include "odometry/sweep_record.hpp"
#include "rilo/cloud/preprocess.hpp"
#include "rilo/odometry/adaptive_threshold.hpp"
#include "rilo/odometry/health.hpp"
#include "rilo/odometry/initial_pose.hpp"
#include "rilo/odometry/motion_prior.hpp"
#include "rilo/odometry/time_budget.hpp"
#include "rilo/registration/adaptive_icp.hpp"
#include "rilo/registration/beam_calibration.hpp"
#include "rilo/registration/elevation_offset.hpp"
#include "rilo/registration/uneven_motion.hpp"

namespace rilo {

namespace {
constexpr std::size_t kStartSweeps = 3;  // the prediction means nothing before
constexpr std::size_t kYoungSweeps = 5;
constexpr int kFirstSweepRounds = 3;
constexpr double kShrunk = 1.0 / 3.0;  // of the median range a sweep ago: doors and passing lorries take less at once
constexpr std::size_t kElevationStride = 4;
constexpr std::size_t kUnevenStride = 4;

std::size_t workers(const OdometryConfig& config) {
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::max(allowed, static_cast<std::size_t>(std::max(config.threads, 0)));
}

/// A sweep as registered: what is judged.
struct Registration {
  IcpResult icp;
  SE3 T_init = SE3::Identity();  // where it started
  std::optional<LocalMap> map;   // begun anew with the velocity found: the second sweep of a map
  double score = 0;              // on the map at the pose found
};
}  // namespace

class Odometry::Impl {
 public:
  Impl(const OdometryConfig& config, Clock clock)
      : config_(validated(config)),
        clock_(std::move(clock)),
        workers_(tbb::global_control::max_allowed_parallelism, workers(config)),
        arena_(config.threads > 0 ? config.threads : tbb::task_arena::automatic),
        preprocessor_(config.preprocess),
        initial_pose_(config.initial_pose, config.coarse),
        threshold_(config.threshold),
        map_(config.map),
        elevation_(config.elevation),
        beams_(config.beams),
        budget_(config.budget),
        tracker_(config.prediction, config.prior, config.bounds) {
    if (budget_.limited() && !clock_) {
      throw std::invalid_argument("configuration: budget.sweep_ms is set, but the odometry was given no clock");
    }
    preprocessor_.track_beams(config.beams.enabled);
    preprocessor_.set_elevation_offset(elevation_.applied_rad());
  }

  SweepResult register_sweep(const SweepView& sweep) {
    SweepResult result;
    arena_.execute([&] { result = process(sweep); });
    return result;
  }

  void reset();

  const Trajectory& trajectory() const { return trajectory_; }
  const SweepMap& map() const { return map_; }
  void keep_intensities(bool kept) { preprocessor_.keep_intensities(kept); }

 private:
  SweepResult process(const SweepView& sweep);
  void begin_map(const PreparedSweep& prepared, const MotionState& state, SweepResult& result);
  void register_prepared(const PreparedSweep& prepared, SweepResult& result);
  MotionState predict(const PreparedSweep& prepared);
  bool started() const { return map_.sweeps() >= kStartSweeps; }
  bool time_left() const;
  InitialPose initial_pose(const PreparedSweep& prepared, const MotionState& predicted, SweepResult& result);
  Registration fine_registration(const PreparedSweep& prepared, const MotionState& predicted, const InitialPose& init);
  Registration second_sweep_registration(const PreparedSweep& prepared, const MotionState& initial,
                                         const MotionPrior& prior);
  Evidence weigh(const PreparedSweep& prepared, const Registration& registration, MotionVerdict motion);
  void accept(const PreparedSweep& prepared, Registration registration, MotionVerdict motion, SweepResult& result);
  void learn_elevation(const PreparedSweep& prepared, const IcpResult& icp, bool sound);
  void lose(const PreparedSweep& prepared, const MotionState& predicted, const std::optional<SE3>& claim,
            SweepResult& result);
  void record_state(SweepResult& result) const;

  OdometryConfig config_;
  StageClock clock_;
  tbb::global_control workers_;  // more than the machine has, if so told
  tbb::task_arena arena_;
  Preprocessor preprocessor_;
  InitialPoseStage initial_pose_;
  AdaptiveThreshold threshold_;
  SweepMap map_;
  ElevationOffsetEstimator elevation_;
  BeamCalibration beams_;
  TimeBudget budget_;
  RigidLever elevation_lever_;  // how the last pose moves with the sensor's elevation angles
  Trajectory trajectory_;
  SweepClock sweep_clock_;
  MotionTracker tracker_;
  PoseCovariance pose_covariance_;
  Eigen::Vector3d last_step_ = Eigen::Vector3d::Zero();  // displacement of the last sweep, sensor frame
  double median_range_m_ = 0;                            // of the last sweep in the map
  Fingerprint fingerprint_;                              // of the last sweep
  int lost_on_this_map_ = 0;                             // so many sweeps in a row
  int coarse_starts_ = 0;                                // of the sweep in work
};

SweepResult Odometry::Impl::process(const SweepView& sweep) {
  SweepResult result;
  coarse_starts_ = 0;
  clock_.begin();
  if (budget_.limited()) {
    preprocessor_.set_source_points(budget_.point_share() * static_cast<double>(config_.preprocess.source_points));
    result.stats.points_cut = budget_.point_share() < 1.0;
  }
  const PreparedSweep& prepared = preprocessor_.prepare(sweep);
  record(sweep, prepared, result.stats);
  result.stats.times.preprocess_ms = clock_.lap_ms();
  const SweepTime time = sweep_clock_.advance(prepared.mid_stamp_ns);
  result.stamp_ns = time.stamp_ns;
  tracker_.advance(time.step_ns);
  const Fingerprint before = std::exchange(fingerprint_, Fingerprint(sweep.points));
  const bool repeated = fingerprint_ == before;  // a driver that hangs: nothing was seen since
  if (prepared.source.points.empty() || repeated) {
    result.status = OdometryStatus::kEmpty;
    if (map_.sweeps() > 0) {
      lose(prepared, predict(prepared), std::nullopt, result);
    }
  } else if (map_.sweeps() == 0) {
    begin_map(prepared, {}, result);
  } else {
    register_prepared(prepared, result);
  }
  record_state(result);
  trajectory_.push_back({result.stamp_ns, result.T_odom_lidar});
  result.stats.times.total_ms = clock_.total_ms();
  if (budget_.limited()) {
    const double coarse_ms = coarse_starts_ > 0 ? result.stats.times.initial_pose_ms : 0.0;
    budget_.learn(result.stats.times.total_ms, coarse_ms, coarse_starts_);
    result.stats.over_budget = result.stats.times.total_ms > config_.budget.sweep_ms;
  }
  return result;
}

void Odometry::Impl::record_state(SweepResult& result) const {
  result.T_odom_lidar = tracker_.state().T_odom_lidar;
  result.twist = tracker_.state().twist;
  result.stats.map_voxels = map_.map().size();
  result.stats.elevation_offset_rad = elevation_.offset_rad();
  result.stats.elevation_offset_sigma_rad = elevation_.sigma_rad();
  result.stats.elevation_applied_rad = elevation_.applied_rad();
  const Eigen::Vector2d beams_rad = beams_.rms_rad();
  result.stats.beam_elevation_rms_rad = beams_rad.x();
  result.stats.beam_azimuth_rms_rad = beams_rad.y();
}

void Odometry::Impl::begin_map(const PreparedSweep& prepared, const MotionState& state, SweepResult& result) {
  result.status = OdometryStatus::kInitialising;
  median_range_m_ = prepared.median_range_m;
  map_.begin(prepared.map_cloud, state, prepared.scene_range_m, elevation_lever_);
  tracker_.begin(state);
  initial_pose_.begin(prepared.source, state, map_.map());
  lost_on_this_map_ = 0;
}

void Odometry::Impl::register_prepared(const PreparedSweep& prepared, SweepResult& result) {
  result.stats.sigma_th_m = threshold_.sigma_th_m();
  map_.map().set_scene_range(prepared.scene_range_m);

  // Motion prediction (III-B), coarse registration (III-A) and choice of the initial pose (III-B).
  const MotionState predicted = predict(prepared);
  const InitialPose init = initial_pose(prepared, predicted, result);
  result.stats.times.initial_pose_ms = clock_.lap_ms();

  // Adaptive ICP (III-D).
  Registration registration = fine_registration(prepared, predicted, init);
  const IcpResult& icp = registration.icp;
  record(icp, result.stats);
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  result.translation_evidence = R.transpose() * icp.degeneracy.translation_evidence() * R;
  result.stats.times.registration_ms = clock_.lap_ms();

  // Judging comes before anything is learnt. Then adaptive threshold (III-C) and local map.
  const MotionVerdict motion = tracker_.weigh(icp.state.T_odom_lidar);
  const Evidence evidence = weigh(prepared, registration, motion);
  result.stats.map_score = evidence.score;
  result.status = judge(icp, evidence, config_.health);
  if (result.status != OdometryStatus::kLost) {
    accept(prepared, std::move(registration), motion, result);
  } else if (fits_map(icp, evidence, config_.health)) {
    lose(prepared, predicted, icp.state.T_odom_lidar, result);
  } else {
    lose(prepared, predicted, std::nullopt, result);
  }
  result.stats.times.map_ms = clock_.lap_ms();
}

MotionState Odometry::Impl::predict(const PreparedSweep& prepared) {
  MotionState predicted = tracker_.predicted(threshold_.sigma_th_m());
  const std::optional<MotionState> claimed = tracker_.predicted_from_claim();
  if (claimed && initial_pose_.score(prepared.source, *claimed, map_.map()) >
                     initial_pose_.score(prepared.source, predicted, map_.map())) {
    return *claimed;
  }
  return predicted;
}

/// For a second look at a sweep. Where nothing is known yet it is worth being late.
bool Odometry::Impl::time_left() const {
  return !budget_.limited() || !started() || budget_.coarse_fits(clock_.total_ms());
}

InitialPose Odometry::Impl::initial_pose(const PreparedSweep& prepared, const MotionState& predicted,
                                         SweepResult& result) {
  const auto twist_at = [&](const SE3& T) { return tracker_.implied_twist(T); };
  InitialPose init =
      initial_pose_.choose(prepared.source, predicted, tracker_.trusted().T_odom_lidar, twist_at, map_.map(),
                           map_.first_can_be_compensated(), !started() || tracker_.lost(), [&] { return time_left(); });
  coarse_starts_ = init.coarse_starts;
  record(init, result.stats);
  return init;
}

Registration Odometry::Impl::fine_registration(const PreparedSweep& prepared, const MotionState& predicted,
                                               const InitialPose& init) {
  MotionState initial = predicted;
  std::optional<MotionState> refuted;
  if (init.source == InitialPoseSource::kCoarse || tracker_.lost()) {
    // The sweep has just refuted the prediction: start where it fits, with the velocity that this implies.
    initial = {init.T_odom_lidar, tracker_.implied_twist(init.T_odom_lidar)};
    refuted = initial;
  }
  if (map_.first_can_be_compensated()) {
    return second_sweep_registration(prepared, initial, tracker_.prior(refuted));
  }
  const auto registered = [&](const MotionState& start, const MotionPrior& prior) {
    Registration done{adaptive_icp(prepared.source, map_.map(), start, prior, threshold_.sigma_th_m(), config_.icp),
                      start.T_odom_lidar,
                      {}};
    done.score = initial_pose_.score(prepared.source, done.icp.state, map_.map());
    return done;
  };
  Registration found = registered(initial, tracker_.prior(refuted));
  if (initial_pose_.suspicious(found.score, found.icp.residual_rms_m)) {
    // Sweeps that are missing, or in another order, lie elsewhere on the path.
    const double period_s = static_cast<double>(sweep_clock_.period_ns()) * 1e-9;
    for (const SE3& place : initial_pose_.places_on_path(prepared.source, predicted, period_s, map_.map())) {
      if (!time_left()) {
        break;
      }
      const MotionState start{place, tracker_.implied_twist(place)};
      Registration other = registered(start, tracker_.prior(start));
      if (other.score * found.icp.residual_rms_m >
          (1.0 + config_.initial_pose.margin) * found.score * other.icp.residual_rms_m) {
        found = std::move(other);
      }
    }
  }
  return found;
}

/// The first sweep went into the map as if the sensor had stood still. It is compensated for the velocity that the
/// second one implies, which the registration refines.
Registration Odometry::Impl::second_sweep_registration(const PreparedSweep& prepared, const MotionState& initial,
                                                       const MotionPrior& prior) {
  Registration found;
  found.icp.state = initial;
  found.T_init = initial.T_odom_lidar;
  int iterations = 0;
  double sigma_m = threshold_.sigma_th_m();
  for (int round = 0; round < kFirstSweepRounds; ++round) {
    found.map = map_.first_compensated(found.icp.state.twist, prepared.scene_range_m, elevation_lever_);
    found.icp = adaptive_icp(prepared.source, *found.map, found.icp.state,
                             round == 0 ? prior : tracker_.prior(found.icp.state), sigma_m, config_.icp);
    iterations += found.icp.iterations;
    sigma_m = std::max(0.5 * sigma_m, config_.threshold.floor_m);  // each round starts nearer
  }
  found.icp.iterations = iterations;
  found.score = initial_pose_.score(prepared.source, found.icp.state, *found.map);
  return found;
}

Evidence Odometry::Impl::weigh(const PreparedSweep& prepared, const Registration& registration, MotionVerdict motion) {
  Evidence evidence;
  evidence.source_points = prepared.source.size();
  evidence.score = registration.score;
  evidence.second_sweep = map_.sweeps() == 1;
  evidence.young_map = map_.sweeps() > 1 && map_.sweeps() < kYoungSweeps;
  evidence.usual_score = initial_pose_.expected_score();
  evidence.was_lost = tracker_.lost();
  evidence.shrunk = prepared.median_range_m < kShrunk * median_range_m_;
  evidence.possible_motion = motion != MotionVerdict::kImpossible;
  return evidence;
}

void Odometry::Impl::accept(const PreparedSweep& prepared, Registration registration, MotionVerdict motion,
                            SweepResult& result) {
  const IcpResult& icp = registration.icp;
  if (registration.map) {
    map_.replace(std::move(*registration.map));
  }
  const bool degenerate = result.status == OdometryStatus::kDegenerate;
  const Vector6d uneven = uneven_motion(prepared.source, map_.map(), icp, threshold_.sigma_th_m(), config_.icp,
                                        PoseCovariance::evidence_share(config_.icp), kUnevenStride);
  result.covariance = pose_covariance_.of(icp, degenerate, tracker_.trusted().twist,
                                          prepared.source.timed() ? tracker_.since_trusted_s() : 0.0, uneven);
  const Eigen::Vector3d step = tracker_.accept(icp, motion, degenerate);
  if (map_.sweeps() >= 2) {
    threshold_.update(registration.T_init, tracker_.state().T_odom_lidar, step - last_step_);
    result.stats.gamma = threshold_.gamma();
    result.stats.deviation_m = threshold_.deviation_m();
  }
  last_step_ = step;
  const bool sound = result.status == OdometryStatus::kOk && started();
  if (config_.elevation.enabled) {
    learn_elevation(prepared, icp, sound);
  }
  if (config_.beams.enabled && sound) {
    beams_.learn(prepared.beam_sample, map_.map(), icp, threshold_.sigma_th_m(), config_.icp);
    preprocessor_.set_beam_angles(beams_.angles());
  }
  lost_on_this_map_ = 0;
  initial_pose_.learn(result.stats.map_score, icp.residual_rms_m);
  initial_pose_.keep_target(prepared.source, tracker_.state().twist);
  median_range_m_ = prepared.median_range_m;
  map_.insert(prepared.map_cloud, tracker_.state(), elevation_lever_);
}

void Odometry::Impl::learn_elevation(const PreparedSweep& prepared, const IcpResult& icp, bool sound) {
  const ElevationInformation sweep = elevation_information(prepared.source, map_.map(), icp, threshold_.sigma_th_m(),
                                                           config_.icp, elevation_lever_, kElevationStride);
  elevation_lever_ = sweep.pose;
  if (!sound) {
    return;
  }
  elevation_.add(sweep);
  const double change = elevation_.advance();
  if (change != 0.0) {
    map_.map().turn_elevation(change, elevation_lever_);
    preprocessor_.set_elevation_offset(elevation_.applied_rad());
  }
}

void Odometry::Impl::lose(const PreparedSweep& prepared, const MotionState& predicted, const std::optional<SE3>& claim,
                          SweepResult& result) {
  result.covariance = unknown_velocity_covariance();
  threshold_.widen();
  tracker_.lose(predicted, claim);
  if (result.status == OdometryStatus::kEmpty) {
    return;  // nothing contradicts the map
  }
  if (++lost_on_this_map_ >= (started() ? config_.health.restart_after : 1)) {
    // The old map does not fit any more, and waiting longer will not help: go on from here. A map that has hardly begun
    // may be the wrong one of the two.
    begin_map(prepared, predicted, result);
  }
}

void Odometry::Impl::reset() {
  initial_pose_.reset();
  threshold_.reset();
  elevation_.reset();
  preprocessor_.reset();
  preprocessor_.set_elevation_offset(elevation_.applied_rad());
  beams_.reset();
  budget_.reset();
  pose_covariance_.reset();
  sweep_clock_.reset();
  tracker_.reset();
  map_.clear();
  elevation_lever_ = {};
  trajectory_.clear();
  fingerprint_ = {};
  last_step_.setZero();
  median_range_m_ = 0.0;
  lost_on_this_map_ = 0;
}

Odometry::Odometry(const OdometryConfig& config, Clock clock)
    : impl_(std::make_unique<Impl>(config, std::move(clock))) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

SweepResult Odometry::register_sweep(const SweepView& sweep) { return impl_->register_sweep(sweep); }

const Trajectory& Odometry::trajectory() const { return impl_->trajectory(); }

std::vector<Eigen::Vector3f> Odometry::local_map() const { return impl_->map().map().points(); }

const std::vector<Eigen::Vector3f>& Odometry::last_map_points() const { return impl_->map().last_points(); }

void Odometry::keep_intensities(bool kept) { impl_->keep_intensities(kept); }

const std::vector<float>& Odometry::last_map_intensities() const { return impl_->map().last_intensities(); }

void Odometry::reset() { impl_->reset(); }

}  // namespace rilo
