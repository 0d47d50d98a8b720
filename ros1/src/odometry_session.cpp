#include "odometry_session.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "base_frame.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/io/live_source.hpp"
#include "rilo/io/map_writer.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::ros1 {
namespace {

std::int64_t steady_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

class OdometrySession::Impl {
 public:
  Impl(const NodeOptions& options, std::shared_ptr<LiveQueue> waiting)
      : source_options(options.source),
        queue(std::move(waiting)),
        odometry(options.config, steady_ns),
        map_voxel_m(options.map_voxel_m),
        map(options.map_voxel_m),
        T_base_lidar(options.T_base_lidar.value_or(SE3::Identity())) {}

  std::vector<Eigen::Vector3f> in_odom_frame(std::vector<Eigen::Vector3f> points) const {
    transform_points(T_world_odom * T_base_lidar, points);
    return points;
  }

  SourceOptions source_options;
  std::shared_ptr<LiveQueue> queue;
  std::unique_ptr<ScanSource> source;
  std::optional<Sweep> sweep;
  Odometry odometry;
  double map_voxel_m;
  ThinnedMap map;
  SE3 T_base_lidar;
  SE3 T_world_odom = SE3::Identity();  // what set_pose() said
};

OdometrySession::OdometrySession(const NodeOptions& options, std::shared_ptr<LiveQueue> queue)
    : impl_(std::make_unique<Impl>(options, std::move(queue))) {}
OdometrySession::~OdometrySession() = default;

bool OdometrySession::next_sweep() {
  if (!impl_->source) impl_->source = open_live_source(impl_->queue, impl_->source_options);
  impl_->sweep = impl_->source->next();
  return impl_->sweep.has_value();
}

SourceFigures OdometrySession::figures() const {
  const SourceInfo info = impl_->source->info();
  const StampFaults& faults = info.faults;
  return {faults.gaps,        faults.missing,   faults.duplicates, faults.out_of_order,
          faults.clock_jumps, info.point_times, info.frame_id};
}

void OdometrySession::set_extrinsic(const SE3& T_base_lidar) { impl_->T_base_lidar = T_base_lidar; }

SweepResult OdometrySession::register_sweep() {
  const SweepResult result = impl_->odometry.register_sweep(*impl_->sweep);
  if (impl_->map_voxel_m > 0 && belongs_in_map(result.status, !impl_->sweep->times_s.empty())) {
    impl_->map.add(impl_->odometry.last_map_points(), result.T_odom_lidar);
  }
  return of_base(result, impl_->T_base_lidar, impl_->T_world_odom);
}

double OdometrySession::last_step_s() const {
  const Trajectory& poses = impl_->odometry.trajectory();
  if (poses.size() < 2) return 0;
  return static_cast<double>(poses.back().stamp_ns - poses[poses.size() - 2].stamp_ns) * 1e-9;
}

void OdometrySession::reset() {
  impl_->odometry.reset();
  impl_->map = ThinnedMap(impl_->map_voxel_m);
  impl_->T_world_odom = SE3::Identity();
}

void OdometrySession::set_pose(const SE3& T_odom_base) {
  const Trajectory& poses = impl_->odometry.trajectory();
  const SE3 now =
      base_pose(poses.empty() ? SE3::Identity() : poses.back().T_odom_lidar, impl_->T_base_lidar, SE3::Identity());
  impl_->T_world_odom = renormalised(T_odom_base * now.inverse());
}

Trajectory OdometrySession::path() const {
  Trajectory path = impl_->odometry.trajectory();
  for (StampedPose& pose : path) {
    pose.T_odom_lidar = base_pose(pose.T_odom_lidar, impl_->T_base_lidar, impl_->T_world_odom);
  }
  return path;
}

std::vector<Eigen::Vector3f> OdometrySession::local_map() const {
  return impl_->in_odom_frame(impl_->odometry.local_map());
}

std::vector<Eigen::Vector3f> OdometrySession::map() const {
  return impl_->map.points().empty() ? local_map() : impl_->in_odom_frame(impl_->map.points());
}

void save_map(const std::string& file, const std::vector<Eigen::Vector3f>& points) {
  write_map(file, MapCloud{points, {}, {}});
}

}  // namespace rilo::ros1
