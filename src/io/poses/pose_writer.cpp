#include <iterator>

#include <fmt/format.h>

#include "io/atomic_file.hpp"
#include "io/unit_quaternion.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

std::string kitti_line(const SE3& pose) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      fmt::format_to(std::back_inserter(text), "{}{:.12e}", row + column == 0 ? "" : " ", pose(row, column));
    }
  }
  return text + '\n';
}

void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) text += kitti_line(pose.T_odom_lidar);
  write_atomically(file, text);
}

void write_kitti_poses(const std::filesystem::path& file, const std::vector<SE3>& poses) {
  std::string text;
  for (const SE3& pose : poses) text += kitti_line(pose);
  write_atomically(file, text);
}

void write_kitti_poses_camera(const std::filesystem::path& file, const Trajectory& trajectory, const SE3& T_cam_lidar) {
  const SE3 T_lidar_cam = T_cam_lidar.inverse();
  std::string text;
  for (const StampedPose& pose : trajectory) text += kitti_line(T_cam_lidar * pose.T_odom_lidar * T_lidar_cam);
  write_atomically(file, text);
}

void write_tum(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d t = pose.T_odom_lidar.translation();
    const Eigen::Quaterniond q = detail::unit_quaternion(pose.T_odom_lidar);
    fmt::format_to(std::back_inserter(text), "{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n",
                   format_stamp(pose.stamp_ns), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_atomically(file, text);
}

void write_euroc(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::string text = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d t = pose.T_odom_lidar.translation();
    const Eigen::Quaterniond q = detail::unit_quaternion(pose.T_odom_lidar);
    fmt::format_to(std::back_inserter(text), "{},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f},{:.12f}\n", pose.stamp_ns,
                   t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
  }
  write_atomically(file, text);
}

void write_stamps(const std::filesystem::path& file, const std::vector<std::int64_t>& stamps_ns) {
  std::string text;
  for (const std::int64_t stamp : stamps_ns) text += format_stamp(stamp) + '\n';
  write_atomically(file, text);
}

}  // namespace rilo
