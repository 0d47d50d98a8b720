// The odometry on ROS topics.
#pragma once

#include <atomic>
#include <cstdint>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <memory>
#include <mutex>
#include <nav_msgs/Path.h>
#include <optional>
#include <rilo_ros/SaveMap.h>
#include <rilo_ros/SetPose.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <string>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <thread>
#include <topic_tools/shape_shifter.h>
#include <vector>

#include "node_health.hpp"
#include "node_options.hpp"
#include "odometry_session.hpp"

namespace rilo::ros1 {

/// Messages come in on ROS' threads and wait in a queue; one thread of its own takes the sweeps and publishes.
class OdometryNode {
 public:
  /// @throws std::invalid_argument as Odometry.
  explicit OdometryNode(const NodeOptions& options);
  ~OdometryNode();
  OdometryNode(const OdometryNode&) = delete;
  OdometryNode& operator=(const OdometryNode&) = delete;

 private:
  // ROS' threads
  void on_cloud(const topic_tools::ShapeShifter::ConstPtr& message);
  void on_initial_pose(const geometry_msgs::PoseWithCovarianceStamped& message);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_set_pose(rilo_ros::SetPose::Request& request, rilo_ros::SetPose::Response& response);
  bool on_save_map(rilo_ros::SaveMap::Request& request, rilo_ros::SaveMap::Response& response);
  std::string set_pose(const geometry_msgs::Pose& pose);

  // The thread of the odometry
  void work();
  bool step();
  bool find_extrinsic(const std::string& lidar_frame);
  void process(std::size_t clock_jumps);
  void publish(const SweepResult& result, double step_s);

  void advertise();
  void reset();
  nav_msgs::Path path() const;
  sensor_msgs::PointCloud2 local_map() const;

  NodeOptions options_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_{"~"};
  std::shared_ptr<LiveQueue> queue_;
  NodeHealth health_;
  diagnostic_updater::Updater diagnostics_;
  tf2_ros::TransformBroadcaster broadcaster_;

  mutable std::mutex mutex_;  // for the session (all but next_sweep()) and what was last published
  OdometrySession session_;
  std::int64_t last_stamp_ns_ = 0;
  std::optional<std::int64_t> path_stamp_ns_;
  std::optional<std::int64_t> map_stamp_ns_;

  std::string base_frame_;  // once it is known
  bool extrinsic_known_ = false;
  std::size_t jumps_seen_ = 0;
  std::atomic<bool> stopping_{false};

  ros::Publisher odometry_publisher_;
  ros::Publisher path_publisher_;
  ros::Publisher map_publisher_;
  ros::Subscriber cloud_subscriber_;
  ros::Subscriber pose_subscriber_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer timer_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace rilo::ros1
