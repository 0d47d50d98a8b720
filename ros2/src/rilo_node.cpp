// rilo_node: LiDAR odometry as a ROS 2 node of its own. Topics, parameters and services: docs/ros2.md.
#include <cstdlib>
#include <exception>
#include <memory>
#include <rclcpp/rclcpp.hpp>

#include "odometry_node.hpp"

int main(int argc, char** argv) {
  bool failed = false;
  try {
    rclcpp::init(argc, argv);  // reads the parameter file
    const auto node = std::make_shared<rilo::ros2::OdometryNode>(rclcpp::NodeOptions());
    rclcpp::spin(node);
    failed = node->failed();
  } catch (const std::exception& error) {
    RCLCPP_FATAL(rclcpp::get_logger("rilo"), "%s", error.what());
    failed = true;
  }
  rclcpp::shutdown();
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
