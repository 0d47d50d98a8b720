// The odometry on ROS 2 topics, as a component and as rilo_node.
#pragma once

#include <atomic>
#include <cstddef>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <future>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <nav_msgs/msg/path.hpp>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <rilo_ros2/srv/save_map.hpp>
#include <rilo_ros2/srv/set_pose.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <tf2_ros/transform_broadcaster.h>
#include <thread>
#include <vector>

#include "rilo/node/live_odometry.hpp"

namespace rilo::ros2 {

class TransformSource;

/// Sweeps come in on a thread of their own, the rest on the executor's; the thread of LiveOdometry publishes.
class OdometryNode final : public rclcpp::Node, private NodeOutput {
 public:
  /// @throws as declare_options().
  explicit OdometryNode(const rclcpp::NodeOptions& options);
  ~OdometryNode() override;

  /// Whether it ended with an error.
  bool failed() const { return failed_; }

 private:
  using PointCloud2 = sensor_msgs::msg::PointCloud2;

  void advertise();
  void subscribe();
  void on_cloud(PointCloud2::ConstSharedPtr message);
  void on_initial_pose(const geometry_msgs::msg::PoseWithCovarianceStamped& message);
  rcl_interfaces::msg::SetParametersResult on_parameters(const std::vector<rclcpp::Parameter>& parameters);
  void report();
  void publish_present();
  void serve_newcomers();

  void publish(const OdometryMessage& message) override;
  void publish(const TransformMessage& message) override;
  void publish(const PathMessage& message) override;
  void publish(CloudMessage&& message) override;
  bool path_wanted() const override;
  bool local_map_wanted() const override;
  std::optional<SE3> look_up(const std::string& base_frame, const std::string& lidar_frame) override;
  void warn(const std::string& text) override;
  void fail(const std::string& why) override;

  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<TransformSource> transforms_;  // until one is found
  std::atomic<bool> failed_{false};
  LiveOdometry odometry_;

  rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr odometry_publisher_;
  rclcpp::Publisher<nav_msgs::msg::Path>::SharedPtr path_publisher_;
  rclcpp::Publisher<PointCloud2>::SharedPtr map_publisher_;
  rclcpp::Publisher<diagnostic_msgs::msg::DiagnosticArray>::SharedPtr diagnostics_publisher_;
  std::size_t path_listeners_ = 0;
  std::size_t map_listeners_ = 0;
  std::promise<void> ended_;
  rclcpp::executors::SingleThreadedExecutor cloud_executor_;
  std::thread cloud_thread_;
  rclcpp::CallbackGroup::SharedPtr cloud_group_;
  rclcpp::Subscription<PointCloud2>::SharedPtr cloud_subscription_;
  rclcpp::Subscription<geometry_msgs::msg::PoseWithCovarianceStamped>::SharedPtr pose_subscription_;
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
  std::vector<rclcpp::TimerBase::SharedPtr> timers_;
  OnSetParametersCallbackHandle::SharedPtr parameters_callback_;
};

}  // namespace rilo::ros2
