// The odometry on ROS topics.
#pragma once

#include <atomic>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <memory>
#include <optional>
#include <rilo_ros/SaveMap.h>
#include <rilo_ros/SetPose.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <string>
#include <tf2_ros/transform_broadcaster.h>
#include <topic_tools/shape_shifter.h>
#include <vector>

#include "rilo/node/live_odometry.hpp"

namespace rilo::ros1 {

class TransformSource;

/// Messages come in on ROS' threads; the thread of LiveOdometry publishes.
class OdometryNode final : private NodeOutput {
 public:
  /// @throws std::invalid_argument as Odometry.
  explicit OdometryNode(const NodeOptions& options);
  ~OdometryNode() override;
  OdometryNode(const OdometryNode&) = delete;
  OdometryNode& operator=(const OdometryNode&) = delete;

  /// Whether it ended with an error.
  bool failed() const { return failed_; }

 private:
  void advertise();
  void on_cloud(const topic_tools::ShapeShifter::ConstPtr& message);
  void on_initial_pose(const geometry_msgs::PoseWithCovarianceStamped& message);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_set_pose(rilo_ros::SetPose::Request& request, rilo_ros::SetPose::Response& response);
  bool on_save_map(rilo_ros::SaveMap::Request& request, rilo_ros::SaveMap::Response& response);

  void publish(const OdometryMessage& message) override;
  void publish(const TransformMessage& message) override;
  void publish(const PathMessage& message) override;
  void publish(CloudMessage&& message) override;
  bool path_wanted() const override;
  bool local_map_wanted() const override;
  std::optional<SE3> look_up(const std::string& base_frame, const std::string& lidar_frame) override;
  void warn(const std::string& text) override;
  void fail(const std::string& why) override;

  ros::NodeHandle node_;
  ros::NodeHandle private_node_{"~"};
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<TransformSource> transforms_;  // until one is found
  std::atomic<bool> failed_{false};
  LiveOdometry odometry_;
  diagnostic_updater::Updater diagnostics_;

  ros::Publisher odometry_publisher_;
  ros::Publisher path_publisher_;
  ros::Publisher map_publisher_;
  ros::Subscriber cloud_subscriber_;
  ros::Subscriber pose_subscriber_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer timer_;
};

}  // namespace rilo::ros1
