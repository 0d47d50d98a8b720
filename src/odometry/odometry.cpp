#include "rilo/odometry/odometry.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "odometry/pose_covariance.hpp"
#include "odometry/stage_clock.hpp"
#include "odometry/sweep_record.hpp"
#include "rilo/cloud/deskew.hpp"
#include "rilo/cloud/preprocess.hpp"
#include "rilo/map/local_map.hpp"
#include "rilo/odometry/adaptive_threshold.hpp"
#include "rilo/odometry/health.hpp"
#include "rilo/odometry/initial_pose.hpp"
#include "rilo/odometry/motion_prediction.hpp"
#include "rilo/odometry/motion_prior.hpp"
#include "rilo/odometry/time_budget.hpp"
#include "rilo/registration/adaptive_icp.hpp"
#include "rilo/registration/beam_calibration.hpp"
#include "rilo/registration/elevation_offset.hpp"
#include "rilo/registration/uneven_motion.hpp"

namespace rilo {

namespace {
constexpr std::int64_t kDefaultPeriodNs = 100'000'000;  // until two stamps are known
constexpr std::size_t kStartSweeps = 3;                 // the prediction means nothing before
constexpr std::size_t kYoungSweeps = 5;
constexpr int kFirstSweepRounds = 2;
constexpr std::size_t kElevationStride = 4;
constexpr std::size_t kUnevenStride = 4;

std::size_t workers(const OdometryConfig& config) {
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::max(allowed, static_cast<std::size_t>(std::max(config.threads, 0)));
}
}  // namespace

class Odometry::Impl {
 public:
  Impl(const OdometryConfig& config, Clock clock)
      : config_(config),
        clock_(std::move(clock)),
        workers_(tbb::global_control::max_allowed_parallelism, workers(config)),
        arena_(config.threads > 0 ? config.threads : tbb::task_arena::automatic),
        preprocessor_(config.preprocess),
        initial_pose_(config.initial_pose, config.coarse),
        threshold_(config.threshold),
        map_(config.map),
        elevation_(config.elevation),
        beams_(config.beams),
        budget_(config.budget) {
    validate(config);
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
  const LocalMap& map() const { return map_; }
  const std::vector<Eigen::Vector3f>& map_points() const { return map_points_; }
  const std::vector<float>& map_intensities() const { return map_intensities_; }
  void keep_intensities(bool kept) { preprocessor_.keep_intensities(kept); }

 private:
  SweepResult process(const SweepView& sweep);
  void start(const PreparedSweep& prepared, SweepResult& result);
  void register_prepared(const PreparedSweep& prepared, SweepResult& result);
  IcpResult fine_registration(const PreparedSweep& prepared, const MotionState& predicted, const InitialPose& init,
                              double dt_s, double sigma_th_m);
  IcpResult with_first_sweep_compensated(const PreparedSweep& prepared, IcpResult icp, double dt_s, double sigma_th_m);
  void accept(const PreparedSweep& prepared, const IcpResult& icp, const SE3& T_init, double dt_s, double score,
              SweepResult& result);
  void learn_elevation(const PreparedSweep& prepared, const IcpResult& icp, bool sound);
  void lose(const PreparedSweep& prepared, const MotionState& predicted, SweepResult& result);
  void insert(const TimedCloud& cloud);
  std::int64_t usable_stamp(std::int64_t stamp_ns) const;

  OdometryConfig config_;
  StageClock clock_;
  tbb::global_control workers_;  // more than the machine has, if so told
  tbb::task_arena arena_;
  Preprocessor preprocessor_;
  InitialPoseStage initial_pose_;
  AdaptiveThreshold threshold_;
  LocalMap map_;
  ElevationOffsetEstimator elevation_;
  BeamCalibration beams_;
  TimeBudget budget_;
  RigidLever elevation_lever_;  // how the last pose moves with the sensor's elevation angles
  Trajectory trajectory_;
  MotionState state_;
  PoseCovariance pose_covariance_;
  Matrix6d velocity_covariance_ = unknown_velocity_covariance();
  Eigen::Vector3d last_step_ = Eigen::Vector3d::Zero();  // displacement of the last sweep, sensor frame
  std::size_t sweeps_in_map_ = 0;                        // so many were ever inserted
  bool lost_ = false;                                    // the sweep before was
  bool degenerate_ = false;                              // the sweep before was
  int lost_on_this_map_ = 0;                             // so many sweeps in a row
  std::size_t restarted_at_ = 0;                         // sweeps_in_map_ when the map was last begun
  int coarse_starts_ = 0;                                // of the sweep in work
  TimedCloud first_cloud_;
  std::vector<Eigen::Vector3f> map_points_;
  std::vector<float> map_intensities_;
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
  result.stamp_ns = usable_stamp(prepared.mid_stamp_ns);
  if (sweeps_in_map_ == 0) {
    start(prepared, result);
  } else {
    register_prepared(prepared, result);
  }
  result.T_odom_lidar = state_.T_odom_lidar;
  result.twist = state_.twist;
  result.stats.map_voxels = map_.size();
  result.stats.elevation_offset_rad = elevation_.offset_rad();
  result.stats.elevation_offset_sigma_rad = elevation_.sigma_rad();
  result.stats.elevation_applied_rad = elevation_.applied_rad();
  const Eigen::Vector2d beams_rad = beams_.rms_rad();
  result.stats.beam_elevation_rms_rad = beams_rad.x();
  result.stats.beam_azimuth_rms_rad = beams_rad.y();
  trajectory_.push_back({result.stamp_ns, state_.T_odom_lidar});
  result.stats.times.total_ms = clock_.total_ms();
  if (budget_.limited()) {
    const double coarse_ms = coarse_starts_ > 0 ? result.stats.times.initial_pose_ms : 0.0;
    budget_.learn(result.stats.times.total_ms, coarse_ms, coarse_starts_);
    result.stats.over_budget = result.stats.times.total_ms > config_.budget.sweep_ms;
  }
  return result;
}

void Odometry::Impl::start(const PreparedSweep& prepared, SweepResult& result) {
  if (prepared.source.points.empty()) {
    result.status = OdometryStatus::kEmpty;
    return;
  }
  result.status = OdometryStatus::kInitialising;
  map_.set_scene_range(prepared.scene_range_m);
  first_cloud_ = prepared.map_cloud;
  sweeps_in_map_ = 1;
  insert(prepared.map_cloud);
  initial_pose_.keep_target(prepared.source, state_.twist);
}

void Odometry::Impl::register_prepared(const PreparedSweep& prepared, SweepResult& result) {
  const double dt_s = static_cast<double>(result.stamp_ns - trajectory_.back().stamp_ns) * 1e-9;
  const double sigma_th_m = threshold_.sigma_th_m();
  result.stats.sigma_th_m = sigma_th_m;
  map_.set_scene_range(prepared.scene_range_m);

  // Motion prediction (III-B), coarse registration (III-A) and choice of the initial pose (III-B).
  MotionState predicted{predict_pose(trajectory_, result.stamp_ns, sigma_th_m, config_.prediction), state_.twist};
  if (prepared.source.points.empty()) {
    lose(prepared, predicted, result);
    result.status = OdometryStatus::kEmpty;
    return;
  }
  const bool in_doubt = sweeps_in_map_ < kStartSweeps || lost_;
  // Where nothing is known yet the coarse stage is worth a late sweep.
  const bool hurried = budget_.limited() && sweeps_in_map_ >= kStartSweeps;
  const auto time_left = [&] { return !hurried || budget_.coarse_fits(clock_.total_ms()); };
  const InitialPose init = initial_pose_.choose(prepared.source, predicted, trajectory_.back().T_odom_lidar, dt_s, map_,
                                                in_doubt, time_left);
  coarse_starts_ = init.coarse_starts;
  record(init, result.stats);
  result.stats.times.initial_pose_ms = clock_.lap_ms();

  // Adaptive ICP (III-D).
  IcpResult icp = fine_registration(prepared, predicted, init, dt_s, sigma_th_m);
  if (sweeps_in_map_ == 1) {
    icp = with_first_sweep_compensated(prepared, std::move(icp), dt_s, sigma_th_m);
  }
  record(icp, result.stats);
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  result.translation_evidence = R.transpose() * icp.degeneracy.translation_evidence() * R;
  result.stats.times.registration_ms = clock_.lap_ms();

  // Health, adaptive threshold (III-C) and local map.
  const double score = initial_pose_.score(prepared.source, icp.state, map_);
  result.stats.map_score = score;
  const bool young = sweeps_in_map_ < restarted_at_ + kYoungSweeps;
  const Evidence evidence{prepared.source.size(), score, initial_pose_.usual_score(), lost_, young};
  result.status = judge(icp, evidence, config_.health);
  if (result.status == OdometryStatus::kLost) {
    lose(prepared, predicted, result);
  } else {
    accept(prepared, icp, init.T_odom_lidar, dt_s, score, result);
  }
  result.stats.times.map_ms = clock_.lap_ms();
}

IcpResult Odometry::Impl::fine_registration(const PreparedSweep& prepared, const MotionState& predicted,
                                            const InitialPose& init, double dt_s, double sigma_th_m) {
  MotionState initial = predicted;
  MotionState expected = expected_motion(state_, dt_s);
  Matrix6d covariance = velocity_covariance_;
  if (init.source == InitialPoseSource::kCoarse) {
    // The sweep has just refuted the prediction: start from the coarse result, with the velocity that it implies.
    initial.T_odom_lidar = init.T_odom_lidar;
    initial.twist = se3_log(trajectory_.back().T_odom_lidar.inverse() * init.T_odom_lidar) / dt_s;
    expected = initial;
    covariance = unknown_velocity_covariance();
  }
  MotionPriorConfig prior_config = config_.prior;
  if (degenerate_) {
    // Where nothing is seen, each sweep makes the prior weaker, and at last the least noise or bias outweighs it.
    prior_config.acceleration_m_s2 *= config_.prior.unseen_share;
    prior_config.angular_acceleration_rad_s2 *= config_.prior.unseen_share;
  }
  const MotionPrior prior = motion_prior(expected, covariance, dt_s, prior_config);
  return adaptive_icp(prepared.source, map_, initial, prior, sigma_th_m, config_.icp);
}

IcpResult Odometry::Impl::with_first_sweep_compensated(const PreparedSweep& prepared, IcpResult icp, double dt_s,
                                                       double sigma_th_m) {
  if (!first_cloud_.timed()) {
    return icp;
  }
  // The first sweep went into the map as if the sensor had stood still. Now that its velocity is known, it is put
  // right.
  for (int round = 0; round < kFirstSweepRounds; ++round) {
    map_.clear();
    state_.twist = icp.state.twist;
    insert(first_cloud_);
    const MotionPrior prior = motion_prior(icp.state, unknown_velocity_covariance(), dt_s, config_.prior);
    const int iterations = icp.iterations;
    icp = adaptive_icp(prepared.source, map_, icp.state, prior, sigma_th_m, config_.icp);
    icp.iterations += iterations;
  }
  return icp;
}

void Odometry::Impl::accept(const PreparedSweep& prepared, const IcpResult& icp, const SE3& T_init, double dt_s,
                            double score, SweepResult& result) {
  const SE3 previous = state_.T_odom_lidar;
  const bool degenerate = result.status == OdometryStatus::kDegenerate;
  const Vector6d uneven = uneven_motion(prepared.source, map_, icp, threshold_.sigma_th_m(), config_.icp,
                                        PoseCovariance::evidence_share(config_.icp), kUnevenStride);
  result.covariance = pose_covariance_.of(icp, degenerate, state_.twist, prepared.source.timed() ? dt_s : 0.0, uneven);
  state_ = icp.state;
  state_.T_odom_lidar = renormalised(state_.T_odom_lidar);
  const Matrix12d covariance = icp.posterior_information.ldlt().solve(Matrix12d::Identity());
  velocity_covariance_ = covariance.bottomRightCorner<6, 6>();
  const Eigen::Vector3d step = (previous.inverse() * state_.T_odom_lidar).translation();
  if (sweeps_in_map_ >= 2) {
    threshold_.update(T_init, state_.T_odom_lidar, step - last_step_);
    result.stats.gamma = threshold_.gamma();
    result.stats.deviation_m = threshold_.deviation_m();
  }
  last_step_ = step;
  if (config_.elevation.enabled) {
    learn_elevation(prepared, icp, result.status == OdometryStatus::kOk);
  }
  if (config_.beams.enabled && result.status == OdometryStatus::kOk && sweeps_in_map_ >= kStartSweeps) {
    beams_.learn(prepared.beam_sample, map_, icp, threshold_.sigma_th_m(), config_.icp);
    preprocessor_.set_beam_angles(beams_.angles());
  }
  lost_ = false;
  degenerate_ = degenerate;
  lost_on_this_map_ = 0;
  ++sweeps_in_map_;
  initial_pose_.learn(score);
  initial_pose_.keep_target(prepared.source, state_.twist);
  insert(prepared.map_cloud);
}

void Odometry::Impl::learn_elevation(const PreparedSweep& prepared, const IcpResult& icp, bool sound) {
  const ElevationInformation sweep = elevation_information(prepared.source, map_, icp, threshold_.sigma_th_m(),
                                                           config_.icp, elevation_lever_, kElevationStride);
  elevation_lever_ = sweep.pose;
  if (!sound || sweeps_in_map_ < kStartSweeps) {
    return;
  }
  elevation_.add(sweep);
  const double change = elevation_.advance();
  if (change != 0.0) {
    map_.turn_elevation(change, elevation_lever_);
    preprocessor_.set_elevation_offset(elevation_.applied_rad());
  }
}

void Odometry::Impl::lose(const PreparedSweep& prepared, const MotionState& predicted, SweepResult& result) {
  state_ = predicted;
  velocity_covariance_ = unknown_velocity_covariance();
  result.covariance = unknown_velocity_covariance();
  threshold_.widen();
  lost_ = true;
  if (++lost_on_this_map_ >= config_.health.restart_after && !prepared.source.points.empty()) {
    // The old map does not fit any more, and waiting longer will not help: go on from here.
    lost_on_this_map_ = 0;
    map_.clear();
    initial_pose_.forget_target();
    restarted_at_ = ++sweeps_in_map_;
    insert(prepared.map_cloud);
    initial_pose_.keep_target(prepared.source, state_.twist);
  }
}

void Odometry::Impl::insert(const TimedCloud& cloud) {
  deskew(cloud, state_.twist, map_points_);
  map_intensities_ = cloud.intensities;
  map_.insert(map_points_, state_.T_odom_lidar, elevation_lever_);
  map_.evict(state_.T_odom_lidar.translation());
}

std::int64_t Odometry::Impl::usable_stamp(std::int64_t stamp_ns) const {
  if (trajectory_.empty() || stamp_ns > trajectory_.back().stamp_ns) {
    return stamp_ns;
  }
  const std::size_t n = trajectory_.size();
  const std::int64_t period = n < 2 ? kDefaultPeriodNs : trajectory_[n - 1].stamp_ns - trajectory_[n - 2].stamp_ns;
  return trajectory_.back().stamp_ns + period;
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
  elevation_lever_ = {};
  map_.clear();
  trajectory_.clear();
  state_ = MotionState{};
  velocity_covariance_ = unknown_velocity_covariance();
  last_step_.setZero();
  sweeps_in_map_ = 0;
  restarted_at_ = 0;
  lost_ = false;
  degenerate_ = false;
  lost_on_this_map_ = 0;
  first_cloud_ = TimedCloud{};
  map_points_.clear();
  map_intensities_.clear();
}

Odometry::Odometry(const OdometryConfig& config, Clock clock)
    : impl_(std::make_unique<Impl>(config, std::move(clock))) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

SweepResult Odometry::register_sweep(const SweepView& sweep) { return impl_->register_sweep(sweep); }

const Trajectory& Odometry::trajectory() const { return impl_->trajectory(); }

std::vector<Eigen::Vector3f> Odometry::local_map() const { return impl_->map().points(); }

const std::vector<Eigen::Vector3f>& Odometry::last_map_points() const { return impl_->map_points(); }

void Odometry::keep_intensities(bool kept) { impl_->keep_intensities(kept); }

const std::vector<float>& Odometry::last_map_intensities() const { return impl_->map_intensities(); }

void Odometry::reset() { impl_->reset(); }

}  // namespace rilo
