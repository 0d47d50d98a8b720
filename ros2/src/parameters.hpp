// The node's parameters as rclcpp declares them; names, ranges and meanings are those of NodeParameters.
#pragma once

#include <map>
#include <rclcpp/rclcpp.hpp>
#include <string>
#include <vector>

#include "rilo/node/node_parameters.hpp"

namespace rilo::ros2 {

/// Declares all of them; their values are what the launch file, the parameter file and the command line say.
/// @throws as rilo::node_options().
NodeOptions declare_options(rclcpp::Node& node);

/// Those of NodeParameters, without ROS' own. @throws std::invalid_argument for a type that none of ours has.
std::map<std::string, ParameterValue> own_parameters(const std::vector<rclcpp::Parameter>& parameters);

}  // namespace rilo::ros2
