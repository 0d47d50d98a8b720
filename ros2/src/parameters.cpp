#include "parameters.hpp"

#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <stdexcept>
#include <type_traits>

namespace rilo::ros2 {
namespace {

// The quality of service is told by parameters that rclcpp declares.
bool is_of_ros(const std::string& name) { return name == "use_sim_time" || name.rfind("qos_overrides.", 0) == 0; }

ParameterValue value_of(const std::string& name, const rclcpp::ParameterValue& value) {
  switch (value.get_type()) {
    case rclcpp::PARAMETER_BOOL:
      return value.get<bool>();
    case rclcpp::PARAMETER_INTEGER:
      return value.get<std::int64_t>();
    case rclcpp::PARAMETER_DOUBLE:
      return value.get<double>();
    case rclcpp::PARAMETER_STRING:
      return value.get<std::string>();
    case rclcpp::PARAMETER_DOUBLE_ARRAY:
      return value.get<std::vector<double>>();
    case rclcpp::PARAMETER_INTEGER_ARRAY: {
      const auto& numbers = value.get<std::vector<std::int64_t>>();
      return std::vector<double>(numbers.begin(), numbers.end());
    }
    default:
      throw std::invalid_argument("parameter " + name + ": expected a single value or a list of numbers");
  }
}

rcl_interfaces::msg::ParameterDescriptor descriptor_of(const NodeParameter& parameter) {
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.description = parameter.meaning();
  descriptor.additional_constraints = parameter.expected();
  if (parameter.change() == ParameterChange::kAtReset) {
    descriptor.additional_constraints += "; counts from the next reset on";
  }
  descriptor.read_only = parameter.change() == ParameterChange::kNever;
  if (const auto* real = std::get_if<ConfigKey::Real>(&parameter.binding())) {
    descriptor.floating_point_range.resize(1);
    descriptor.floating_point_range[0].from_value = real->least;
    descriptor.floating_point_range[0].to_value = real->most;
  } else if (const auto* integer = std::get_if<ConfigKey::Integer>(&parameter.binding())) {
    descriptor.integer_range.resize(1);
    descriptor.integer_range[0].from_value = integer->least;
    descriptor.integer_range[0].to_value = integer->most;
  }
  return descriptor;
}

}  // namespace

NodeOptions declare_options(rclcpp::Node& node) {
  std::vector<rclcpp::Parameter> given;
  for (const auto& [name, value] : node.get_node_parameters_interface()->get_parameter_overrides()) {
    if (!node.has_parameter(name)) given.emplace_back(name, value);  // those of ROS are there already
  }
  NodeOptions options = node_options(own_parameters(given));
  const NodeParameters table(options);
  for (const NodeParameter& parameter : table.all()) {
    const auto value = std::visit([](const auto& v) { return rclcpp::ParameterValue(v); }, parameter.value());
    constexpr bool kOverridesAreInIt = true;
    node.declare_parameter(parameter.name(), value, descriptor_of(parameter), kOverridesAreInIt);
  }
  return options;
}

std::map<std::string, ParameterValue> own_parameters(const std::vector<rclcpp::Parameter>& parameters) {
  std::map<std::string, ParameterValue> own;
  for (const rclcpp::Parameter& parameter : parameters) {
    const std::string& name = parameter.get_name();
    if (!is_of_ros(name)) own.emplace(name, value_of(name, parameter.get_parameter_value()));
  }
  return own;
}

}  // namespace rilo::ros2
