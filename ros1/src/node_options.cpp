#include "node_options.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ros/node_handle.h>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "rilo/config/config_file.hpp"

namespace rilo::ros1 {
namespace {

// Takes parameters by name; what is left at the end must be keys of the configuration.
class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& node) : node_(node) {
    std::vector<std::string> all;
    node.getParamNames(all);
    const std::string own = node.getNamespace() + "/";
    for (const std::string& name : all) {
      if (name.rfind(own, 0) == 0) left_.push_back(name.substr(own.size()));
    }
  }

  template <typename T>
  bool take(const std::string& name, T& value, const char* expected) {
    const auto known = std::remove(left_.begin(), left_.end(), name);
    if (known == left_.end()) return false;
    left_.erase(known, left_.end());
    if (!node_.getParam(name, value)) refuse(name, expected);
    return true;
  }
  void take_text(const std::string& name, std::string& value) { take(name, value, "text"); }
  void take_flag(const std::string& name, bool& value) { take(name, value, "true or false"); }
  void take_number(const std::string& name, double& value, double least, double most) {
    const std::string expected = fmt::format("a number from {} to {}", least, most);
    if (take(name, value, expected.c_str()) && !(value >= least && value <= most)) refuse(name, expected);
  }
  void take_count(const std::string& name, std::size_t& value, int most) {
    const std::string expected = fmt::format("a whole number from 0 to {}", most);
    int number = 0;
    if (!take(name, number, expected.c_str())) return;
    if (number < 0 || number > most) refuse(name, expected);
    value = static_cast<std::size_t>(number);
  }
  template <typename Parse, typename Value>
  void take_word(const std::string& name, const Parse& parse, const char* words, Value& value) {
    std::string text;
    if (!take(name, text, words)) return;
    const auto parsed = parse(text);
    if (!parsed) refuse(name, words);
    value = *parsed;
  }

  /// "key=value" of every parameter that nobody took.
  std::vector<std::string> overrides() const {
    std::vector<std::string> settings;
    for (const std::string& name : left_) {
      std::string key = name;
      std::replace(key.begin(), key.end(), '/', '.');
      settings.push_back(key + "=" + text_of(name));
    }
    return settings;
  }

  [[noreturn]] static void refuse(const std::string& name, const std::string& expected) {
    throw std::invalid_argument("parameter ~" + name + ": expected " + expected);
  }

 private:
  std::string text_of(const std::string& name) const {
    XmlRpc::XmlRpcValue value;
    node_.getParam(name, value);
    switch (value.getType()) {
      case XmlRpc::XmlRpcValue::TypeBoolean:
        return static_cast<bool>(value) ? "true" : "false";
      case XmlRpc::XmlRpcValue::TypeInt:
        return std::to_string(static_cast<int>(value));
      case XmlRpc::XmlRpcValue::TypeDouble:
        return fmt::format("{}", static_cast<double>(value));
      case XmlRpc::XmlRpcValue::TypeString:
        return static_cast<std::string>(value);
      default:
        refuse(name, "a single value");
    }
  }

  ros::NodeHandle node_;
  std::vector<std::string> left_;
};

// x, y, z and either a quaternion x, y, z, w or roll, pitch, yaw, as static_transform_publisher takes them.
SE3 extrinsic(const std::vector<double>& v) {
  const char* const expected = "a list of x, y, z, yaw, pitch, roll (m, rad) or x, y, z, qx, qy, qz, qw";
  const bool finite = std::all_of(v.begin(), v.end(), [](double value) { return std::isfinite(value); });
  if ((v.size() != 6 && v.size() != 7) || !finite) Parameters::refuse("base_to_lidar", expected);
  Eigen::Quaterniond q;
  if (v.size() == 6) {
    q = Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitX());
  } else {
    q = Eigen::Quaterniond(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1) > 1e-3) Parameters::refuse("base_to_lidar", "a quaternion of length 1");
  }
  SE3 T = SE3::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() << v[0], v[1], v[2];
  return T;
}

void read_source(Parameters& parameters, SourceOptions& source) {
  parameters.take_word("point_times", parse_point_times, "auto, none or azimuth", source.point_times);
  parameters.take_word("point_time_unit", parse_point_time_unit, "infer, s, ms, us, ns or fraction",
                       source.point_time_unit);
  parameters.take_word("point_time_reference", parse_point_time_reference, "infer, stamp or epoch",
                       source.point_time_reference);
  parameters.take_text("time_field", source.time_field);
  parameters.take_word("spin", parse_spin_direction, "clockwise or counter-clockwise", source.spin_direction);
  parameters.take_number("elevation_correction", source.elevation_correction_deg, -10, 10);
  parameters.take_number("rate", source.assumed_rate_hz, 0.001, 1000);
}

void read_frames(Parameters& parameters, NodeOptions& options) {
  parameters.take_text("odom_frame", options.odom_frame);
  parameters.take_text("base_frame", options.base_frame);
  std::vector<double> base_to_lidar;
  if (parameters.take("base_to_lidar", base_to_lidar, "a list of numbers") && !base_to_lidar.empty()) {
    options.T_base_lidar = extrinsic(base_to_lidar);
  }
  parameters.take_flag("publish_tf", options.publish_tf);
  parameters.take_flag("invert_tf", options.invert_tf);
  if (options.odom_frame.empty()) Parameters::refuse("odom_frame", "the name of a frame");
}

}  // namespace

NodeOptions read_options(const ros::NodeHandle& node) {
  constexpr double kLongestPeriodS = 1e6;
  Parameters parameters(node);
  NodeOptions options;
  read_source(parameters, options.source);
  read_frames(parameters, options);
  parameters.take_count("queue", options.queue.limit, 100000);
  parameters.take_count("look_ahead", options.queue.look_ahead, 12);
  parameters.take_number("path_period", options.path_period_s, 0, kLongestPeriodS);
  parameters.take_number("local_map_period", options.local_map_period_s, 0, kLongestPeriodS);
  parameters.take_number("map_voxel", options.map_voxel_m, 0, 100);
  double diagnostic_updater_reads_it_itself = 1;
  parameters.take_number("diagnostic_period", diagnostic_updater_reads_it_itself, 0, kLongestPeriodS);
  std::string file;
  parameters.take_text("config", file);
  options.config = with_overrides(file.empty() ? OdometryConfig{} : load_config(file), parameters.overrides());
  return options;
}

}  // namespace rilo::ros1
