#include "node/odometry_session.hpp"

#include <algorithm>
#include <utility>

#include "io/steady_clock.hpp"
#include "node/base_frame.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/node/node_parameters.hpp"

namespace rilo {
namespace {

SE3 extrinsic_of(const NodeOptions& options) {
  return options.base_to_lidar.empty() ? SE3::Identity() : pose_from_list(options.base_to_lidar);
}

}  // namespace

OdometrySession::OdometrySession(const NodeOptions& options, std::shared_ptr<LiveQueue> queue)
    : source_options_(options.source),
      calibration_(options.calibration),
      queue_(std::move(queue)),
      odometry_(new_odometry(options.config)),
      map_voxel_m_(options.map_voxel_m),
      most_map_points_(static_cast<std::size_t>(options.map_points)),
      T_base_lidar_(extrinsic_of(options)) {
  if (map_voxel_m_ > 0) map_.emplace(map_voxel_m_);
}

Odometry OdometrySession::new_odometry(const OdometryConfig& config) const {
  Odometry odometry(config, steady_ns);
  if (calibration_) odometry.start_with(*calibration_);
  return odometry;
}

std::vector<Eigen::Vector3f> OdometrySession::in_odom_frame(std::vector<Eigen::Vector3f> points) const {
  transform_points(T_world_odom_ * T_base_lidar_, points);
  return points;
}

bool OdometrySession::next_sweep() {
  bool anew = queue_->take_end_of_source();
  do {
    if (anew && source_) {
      figures_before_ = figures();
      source_.reset();
      given_.clear();
      ++times_opened_;
    }
    if (!source_) source_ = open_live_source(queue_, source_options_);
    sweep_ = source_->next();
    anew = !sweep_ && queue_->take_end_of_source();
  } while (anew);
  return sweep_.has_value();
}

SourceFigures OdometrySession::figures() const {
  const SourceInfo info = source_->info();
  const StampFaults& faults = info.faults;
  const SourceFigures& before = figures_before_;
  return {before.gaps + faults.gaps,
          before.missing + faults.missing,
          before.duplicates + faults.duplicates,
          before.out_of_order + faults.out_of_order,
          before.clock_jumps + faults.clock_jumps,
          info.point_times,
          info.frame_id};
}

std::vector<std::string> OdometrySession::new_warnings() {
  std::vector<std::string> fresh;
  std::vector<std::string> all = source_->info().warnings;
  // `rilo run` finds that out.
  untimed_ = untimed_ || (sweep_->times_s.empty() && !sweep_->points.empty());
  if (untimed_ && source_options_.point_times == PointTimes::kAuto) {
    all.emplace_back(
        "no times of the points: they are used as if they were measured at once. Where they are raw, set point_times "
        "to order or azimuth, else to none");
  }
  for (std::string& warning : all) {
    if (std::find(given_.begin(), given_.end(), warning) == given_.end()) fresh.push_back(std::move(warning));
  }
  given_.insert(given_.end(), fresh.begin(), fresh.end());
  return fresh;
}

void OdometrySession::set_extrinsic(const SE3& T_base_lidar) { T_base_lidar_ = T_base_lidar; }

SweepResult OdometrySession::register_sweep() {
  SweepResult result = odometry_.register_sweep(*sweep_);
  result.stamp_ns = pose_stamp_ns(result.stamp_ns, sweep_->stamp_ns);
  path_.add({result.stamp_ns, result.T_odom_lidar});
  return of_base(result, T_base_lidar_, T_world_odom_);
}

void OdometrySession::add_to_map(OdometryStatus status) {
  if (!map_ || map_is_full() || !belongs_in_map(status, !sweep_->times_s.empty())) return;
  map_->add(odometry_.last_map_points(), odometry_.trajectory().back().T_odom_lidar);
}

double OdometrySession::last_step_s() const {
  const Trajectory& poses = odometry_.trajectory();
  if (poses.size() < 2) return 0;
  return static_cast<double>(poses.back().stamp_ns - poses[poses.size() - 2].stamp_ns) * 1e-9;
}

void OdometrySession::reset(const std::optional<OdometryConfig>& config) {
  if (config) {
    odometry_ = new_odometry(*config);
  } else {
    odometry_.reset();
  }
  path_ = PathPoses();
  if (map_) map_.emplace(map_voxel_m_);
  T_world_odom_ = SE3::Identity();
}

void OdometrySession::set_pose(const SE3& T_odom_base) {
  const Trajectory& poses = odometry_.trajectory();
  const SE3 now =
      base_pose(poses.empty() ? SE3::Identity() : poses.back().T_odom_lidar, T_base_lidar_, SE3::Identity());
  T_world_odom_ = renormalised(T_odom_base * now.inverse());
}

Trajectory OdometrySession::path() const {
  Trajectory path = path_.poses();
  for (StampedPose& pose : path) pose.T_odom_lidar = base_pose(pose.T_odom_lidar, T_base_lidar_, T_world_odom_);
  return path;
}

std::vector<Eigen::Vector3f> OdometrySession::local_map() const { return in_odom_frame(odometry_.local_map()); }

std::vector<Eigen::Vector3f> OdometrySession::map() const {
  return map_points() == 0 ? local_map() : in_odom_frame(map_->points());
}

}  // namespace rilo
