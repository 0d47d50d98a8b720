#include "rilo/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <tbb/task_arena.h>

#include "rilo/cloud/deskew.hpp"
#include "rilo/cloud/preprocess.hpp"
#include "rilo/map/local_map.hpp"
#include "rilo/odometry/adaptive_threshold.hpp"
#include "rilo/odometry/motion_prediction.hpp"
#include "rilo/registration/adaptive_icp.hpp"

namespace rilo {

class Odometry::Impl {
 public:
  Impl(const OdometryConfig& config, Clock clock)
      : config_(config), clock_(std::move(clock)), arena_(config.threads > 0 ? config.threads : tbb::task_arena::automatic),
        preprocessor_(config.preprocess), threshold_(config.threshold), map_(config.map) {}

  SweepResult register_sweep(const Sweep& sweep) {
    SweepResult result;
    arena_.execute([&] { result = process(sweep); });
    return result;
  }

  SweepResult process(const Sweep& sweep);

  MotionPrior motion_prior(double dt) const;

  OdometryConfig config_;
  Clock clock_;
  tbb::task_arena arena_;
  Preprocessor preprocessor_;
  AdaptiveThreshold threshold_;
  LocalMap map_;
  Trajectory trajectory_;
  MotionState state_;
  Matrix6d velocity_covariance_ = Matrix6d::Zero();
  TimedCloud first_cloud_;
  std::vector<Eigen::Vector3f> map_points_;
};

MotionPrior Odometry::Impl::motion_prior(double dt) const {
  MotionPrior prior;
  prior.state.twist = state_.twist;
  prior.state.T_odom_lidar = state_.T_odom_lidar * se3_exp(dt * state_.twist);
  Vector6d q;
  const double qr = config_.icp.angular_acceleration_rad_s2;
  const double qt = config_.icp.acceleration_m_s2;
  q << Eigen::Vector3d::Constant(qr * qr * 0.1), Eigen::Vector3d::Constant(qt * qt * 0.1);
  Matrix12d P;
  const Matrix6d& V = velocity_covariance_;
  const Matrix6d Q = q.asDiagonal();
  P << dt * dt * V + dt * dt * dt / 3.0 * Q, dt * V + dt * dt / 2.0 * Q, dt * V + dt * dt / 2.0 * Q, V + dt * Q;
  prior.information = P.ldlt().solve(Matrix12d::Identity());
  prior.information = 0.5 * (prior.information + prior.information.transpose()).eval();
  return prior;
}

SweepResult Odometry::Impl::process(const Sweep& sweep) {
  SweepResult result;
  const std::int64_t t0 = clock_ ? clock_() : 0;
  const PreparedSweep& prepared = preprocessor_.prepare(sweep);
  const std::int64_t t1 = clock_ ? clock_() : 0;
  result.stamp_ns = prepared.mid_stamp_ns;
  const double sigma = threshold_.sigma_th_m();
  result.stats.sigma_th_m = sigma;
  std::int64_t t2 = t1;
  if (trajectory_.empty()) {
    velocity_covariance_.setZero();
    velocity_covariance_.diagonal() << 1.0, 1.0, 1.0, 100.0, 100.0, 100.0;
    first_cloud_ = prepared.map_cloud;
  } else {
    const double dt = static_cast<double>(result.stamp_ns - trajectory_.back().stamp_ns) * 1e-9;
    const MotionPrior prior = motion_prior(dt);
    MotionState initial = prior.state;
    initial.T_odom_lidar = predict_pose(trajectory_, result.stamp_ns, sigma, config_.prediction);
    if (trajectory_.size() < 2) {
      initial = prior.state;
    }
    const IcpResult icp = adaptive_icp(prepared.source, map_, initial, prior, sigma, config_.icp);
    t2 = clock_ ? clock_() : 0;
    const SE3 before = trajectory_.back().T_odom_lidar;
    state_ = icp.state;
    state_.T_odom_lidar = renormalised(state_.T_odom_lidar);
    const Matrix12d cov = icp.posterior_information.ldlt().solve(Matrix12d::Identity());
    velocity_covariance_ = cov.bottomRightCorner<6, 6>();
    result.stats.iterations = icp.iterations;
    result.stats.converged = icp.converged;
    result.stats.inliers = icp.inliers;
    result.stats.residual_rms_m = icp.residual_rms_m;
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
    if (trajectory_.size() >= 2) {
      const SE3& T1 = trajectory_[trajectory_.size() - 2].T_odom_lidar;
      acceleration = (before.inverse() * state_.T_odom_lidar).translation() - (T1.inverse() * before).translation();
      threshold_.update(initial.T_odom_lidar, state_.T_odom_lidar, acceleration);
    }
    if (trajectory_.size() == 1 && first_cloud_.timed()) {
      map_.clear();
      deskew(first_cloud_, state_.twist, map_points_);
      map_.insert(map_points_, SE3::Identity());
    }
    result.stats.gamma = threshold_.gamma();
    result.stats.deviation_m = threshold_.deviation_m();
    result.status = OdometryStatus::kOk;
  }
  result.T_odom_lidar = state_.T_odom_lidar;
  result.twist = state_.twist;
  trajectory_.push_back({result.stamp_ns, state_.T_odom_lidar});
  deskew(prepared.map_cloud, state_.twist, map_points_);
  map_.insert(map_points_, state_.T_odom_lidar);
  map_.evict(state_.T_odom_lidar.translation());
  const std::int64_t t3 = clock_ ? clock_() : 0;
  result.stats.points_in = sweep.points.size();
  result.stats.points_valid = prepared.valid_points;
  result.stats.points_map = prepared.map_cloud.size();
  result.stats.points_source = prepared.source.size();
  result.stats.map_voxels = map_.size();
  result.stats.times = {static_cast<double>(t1 - t0) * 1e-6, 0, 0, static_cast<double>(t2 - t1) * 1e-6,
                        static_cast<double>(t3 - t2) * 1e-6, static_cast<double>(t3 - t0) * 1e-6};
  return result;
}

Odometry::Odometry(const OdometryConfig& config, Clock clock) : impl_(std::make_unique<Impl>(config, std::move(clock))) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

SweepResult Odometry::register_sweep(const Sweep& sweep) { return impl_->register_sweep(sweep); }
const Trajectory& Odometry::trajectory() const { return impl_->trajectory_; }
std::vector<Eigen::Vector3f> Odometry::local_map() const { return impl_->map_.points(); }
const std::vector<Eigen::Vector3f>& Odometry::last_map_points() const { return impl_->map_points_; }
void Odometry::reset() {}

}  // namespace rilo
