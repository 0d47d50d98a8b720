// The parameters of a node: its own and every key of the configuration, with ranges and meanings. Like all headers of
// this folder C++17, as ROS 1's need it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/config/config_key.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/io/source_options.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// NodeParameters is the table of names, ranges and meanings.
struct NodeOptions {
  std::string config_file;  ///< already in `config`
  OdometryConfig config;
  std::string calibration_file;  ///< already in `calibration`
  std::optional<SensorAngles> calibration;
  SourceOptions source;
  int queue = 2;        ///< LiveQueueOptions::limit
  int look_ahead = 12;  ///< LiveQueueOptions::look_ahead
  std::string odom_frame = "odom";
  std::string base_frame;             ///< empty: the LiDAR's own frame, as the messages name it
  std::vector<double> base_to_lidar;  ///< see pose_from_list(); empty: looked up in TF, where base_frame is another
  bool publish_tf = true;
  bool invert_tf = false;          ///< base_frame is the parent
  double path_period_s = 1;        ///< of the sweeps' stamps; 0: at every sweep
  double local_map_period_s = 1;   ///< the same
  double map_voxel_m = 0.2;        ///< of the map of the whole run, for save_map; 0: none is kept
  int map_points = 20'000'000;     ///< that it has at most; 0: no limit
  double diagnostic_period_s = 1;  ///< of wall time
};

/// As both ROS know them.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// When a new value of a parameter takes effect in a running node.
enum class ParameterChange : std::uint8_t {
  kNever,    ///< only at the start
  kAtOnce,   ///< with the next sweep
  kAtReset,  ///< with the next reset
};

/// One parameter, bound to a member of NodeOptions.
class NodeParameter {
 public:
  using Text = std::string*;
  using List = std::vector<double>*;
  using Binding = std::variant<ConfigKey::Real, ConfigKey::Integer, ConfigKey::Boolean, ConfigKey::Choice, Text, List>;

  NodeParameter(std::string name, std::string meaning, Binding binding, ParameterChange change)
      : name_(std::move(name)), meaning_(std::move(meaning)), binding_(std::move(binding)), change_(change) {}

  const std::string& name() const { return name_; }        ///< "queue", "icp.max_iterations"
  const std::string& meaning() const { return meaning_; }  ///< with the unit
  const Binding& binding() const { return binding_; }
  ParameterChange change() const { return change_; }

  /// "a number from 0 to 100", "true or false", "fixed_tau or map_score", …
  std::string expected() const;
  ParameterValue value() const;
  /// Whole numbers and texts of numbers are numbers, too.
  /// @throws std::invalid_argument, with nothing changed, naming the parameter and what is expected.
  void set(const ParameterValue& value) const;

 private:
  std::string name_;
  std::string meaning_;
  Binding binding_;
  ParameterChange change_;
};

/// The table: the node's own parameters, then the keys of the configuration.
class NodeParameters {
 public:
  /// `options` must outlive it.
  explicit NodeParameters(NodeOptions& options);

  const std::vector<NodeParameter>& all() const { return all_; }

  /// With or without "expert." before it, as in a file of the configuration.
  /// @throws std::invalid_argument when there is none of that name; the nearest one is named.
  const NodeParameter& at(const std::string& given) const;

 private:
  std::vector<NodeParameter> all_;
};

/// Parameters by name. Keys of the configuration count more than the file that `config` names.
/// @throws std::invalid_argument as NodeParameter::set() and NodeParameters::at(), or when values contradict each
/// other; ConfigError: the file.
NodeOptions node_options(const std::map<std::string, ParameterValue>& given);

/// `options` with other values, all of them or none. @throws std::invalid_argument as node_options().
NodeOptions with_parameters(const NodeOptions& options, const std::map<std::string, ParameterValue>& changes);

/// x, y, z and either yaw, pitch, roll (m, rad) or a quaternion x, y, z, w, as static_transform_publisher takes them.
/// @throws std::invalid_argument
SE3 pose_from_list(const std::vector<double>& values);

}  // namespace rilo
