// rilo_node: LiDAR odometry as a ROS 1 node. Topics, parameters and services: docs/ros1.md.
#include <cstdlib>
#include <exception>
#include <ros/ros.h>

#include "node_options.hpp"
#include "odometry_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "rilo_node");
  const ros::NodeHandle node_handle("~");  // with the last one goes the log
  try {
    const rilo::ros1::OdometryNode node(rilo::ros1::read_options(node_handle));
    ros::MultiThreadedSpinner(2).spin();  // saving a map does not keep sweeps waiting
    return node.failed() ? EXIT_FAILURE : EXIT_SUCCESS;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return EXIT_FAILURE;
  }
}
