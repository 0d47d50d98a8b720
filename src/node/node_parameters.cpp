#include "rilo/node/node_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/same_sensor.hpp"
#include "config/nearest_word.hpp"
#include "node/base_frame.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

constexpr double kLongestPeriodS = 1e6;

[[noreturn]] void refuse(const std::string& name, const std::string& expected) {
  throw std::invalid_argument(fmt::format("parameter {}: expected {}", name, expected));
}

struct TextOf {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<double>& value) const { return fmt::format("{}", value); }
};

// What ConfigKey knows to do; texts and lists are no keys of a configuration.
template <typename Binding>
ConfigKey key_of(const std::string& name, const Binding& binding) {
  return {name, {}, binding};
}

struct Expected {
  template <typename Binding>
  std::string operator()(const Binding& binding) const {
    return key_of("", binding).expected();
  }
  std::string operator()(NodeParameter::Text) const { return "a text"; }
  std::string operator()(NodeParameter::List) const { return "a list of numbers"; }
};

struct Value {
  ParameterValue operator()(const ConfigKey::Real& key) const { return *key.member; }
  ParameterValue operator()(const ConfigKey::Integer& key) const { return std::int64_t{*key.member}; }
  ParameterValue operator()(const ConfigKey::Boolean& key) const { return *key.member; }
  ParameterValue operator()(const ConfigKey::Choice& key) const { return key.words.at(key.get()); }
  ParameterValue operator()(NodeParameter::Text text) const { return *text; }
  ParameterValue operator()(NodeParameter::List list) const { return *list; }
};

// False when the value is not what is expected.
struct Set {
  const ParameterValue& value;

  template <typename Binding>
  bool operator()(const Binding& binding) const {
    return key_of("", binding).set(std::visit(TextOf(), value));
  }
  bool operator()(NodeParameter::Text text) const { return take(text); }
  bool operator()(NodeParameter::List list) const { return take(list); }

  template <typename Kind>
  bool take(Kind* into) const {
    const Kind* given = std::get_if<Kind>(&value);
    if (given != nullptr) *into = *given;
    return given != nullptr;
  }
};

// Beside the keys that a configuration file has.
void add_numbers(KeyVisitor& keys, NodeOptions& o) {
  keys.integer({"queue", "", "sweeps that may wait; beyond, the oldest is dropped. 0: all wait"}, o.queue, 0, 100000);
  keys.integer({"look_ahead", "",
                "sweeps looked at before the first pose, for their period. 0: poses at once, the period is 1 / rate"},
               o.look_ahead, 0, 12);
  keys.real({"map_voxel", "m", "voxel of the map that save_map writes; 0: none is kept"}, o.map_voxel_m, 0,
            ThinnedMap::kMostVoxelM);
  keys.integer({"map_points", "", "points that this map has at most, some 20 bytes each; 0: no limit"}, o.map_points, 0,
               1'000'000'000);
}

void add_live_numbers(KeyVisitor& keys, NodeOptions& o) {
  keys.boolean({"publish_tf", "", "odom_frame to base_frame on /tf"}, o.publish_tf);
  keys.boolean({"invert_tf", "", "base_frame is the parent of odom_frame"}, o.invert_tf);
  keys.real({"path_period", "s", "between two paths, by stamps; 0: every sweep"}, o.path_period_s, 0, kLongestPeriodS);
  keys.real({"local_map_period", "s", "between two local maps, by stamps; 0: every sweep"}, o.local_map_period_s, 0,
            kLongestPeriodS);
}

void add_source(KeyVisitor& keys, SourceOptions& s) {
  keys.choice<PointTimes>({"point_times", "", "where the times of the points come from"}, s.point_times,
                          {{"auto", PointTimes::kAuto},
                           {"none", PointTimes::kNone},
                           {"azimuth", PointTimes::kAzimuth},
                           {"order", PointTimes::kOrder}});
  keys.choice<PointTimeUnit>({"point_time_unit", "", "unit of the field of times"}, s.point_time_unit,
                             {{"infer", PointTimeUnit::kInfer},
                              {"s", PointTimeUnit::kSeconds},
                              {"ms", PointTimeUnit::kMilliseconds},
                              {"us", PointTimeUnit::kMicroseconds},
                              {"ns", PointTimeUnit::kNanoseconds},
                              {"fraction", PointTimeUnit::kFraction}});
  keys.choice<PointTimeReference>({"point_time_reference", "", "what they count from"}, s.point_time_reference,
                                  {{"infer", PointTimeReference::kInfer},
                                   {"stamp", PointTimeReference::kStamp},
                                   {"epoch", PointTimeReference::kEpoch}});
  keys.choice<SpinDirection>(
      {"spin", "", "rotation direction seen from above, for times from the azimuth"}, s.spin_direction,
      {{"clockwise", SpinDirection::kClockwise}, {"counter-clockwise", SpinDirection::kCounterClockwise}});
  keys.real({"elevation_correction", "deg", "added to every elevation angle"}, s.elevation_correction_deg, -10, 10);
  keys.real({"rate", "Hz", "of the sweeps, where no period can be seen"}, s.rate_hz.emplace(s.assumed_rate_hz()), 0.001,
            1000);
  keys.integer({"parts", "", "messages that hold a sweep in parts, joined to one; 0: found out"}, s.parts, 0,
               SourceOptions::kMostParts);
}

}  // namespace

std::string NodeParameter::expected() const { return std::visit(Expected(), binding_); }

ParameterValue NodeParameter::value() const { return std::visit(Value(), binding_); }

void NodeParameter::set(const ParameterValue& value) const {
  if (!std::visit(Set{value}, binding_)) refuse(name_, expected() + ", found " + std::visit(TextOf(), value));
}

NodeParameters::NodeParameters(NodeOptions& options) {
  const auto add_keys = [this](const ConfigKeys& keys, ParameterChange change) {
    for (const ConfigSection& section : keys.sections()) {
      for (const ConfigKey& key : section.keys) {
        const std::string unit = key.unit().empty() ? "" : " (" + key.unit() + ")";
        const auto binding = std::visit([](const auto& b) { return NodeParameter::Binding(b); }, key.binding());
        all_.emplace_back(key.name(), key.meaning() + unit, binding, change);
      }
    }
  };
  const auto add_own = [&](const auto& add, auto& members, ParameterChange change) {
    ConfigKeys keys;
    add(keys, members);
    add_keys(keys, change);
  };
  const auto add_text = [this](const char* name, const char* meaning, const NodeParameter::Binding& binding) {
    all_.emplace_back(name, meaning, binding, ParameterChange::kNever);
  };
  add_text("config", "YAML file as for rilo run --config; single keys count more", &options.config_file);
  add_text("calibration", "calibration.yaml of a rilo run with this sensor: its angles from the first sweep on",
           &options.calibration_file);
  add_text("odom_frame", "where the base was at the first sweep", &options.odom_frame);
  add_text("base_frame", "the robot's frame; empty: the LiDAR's own", &options.base_frame);
  add_text("base_to_lidar", "x, y, z, yaw, pitch, roll (m, rad) or x, y, z, qx, qy, qz, qw; empty: from TF",
           &options.base_to_lidar);
  add_text("time_field", "field of the points' times; empty: the first of the usual names", &options.source.time_field);
  add_own(add_live_numbers, options, ParameterChange::kAtOnce);
  add_own(add_numbers, options, ParameterChange::kNever);
  add_own(
      [](KeyVisitor& keys, NodeOptions& o) {
        keys.real({"diagnostic_period", "s", "between two reports, wall time"}, o.diagnostic_period_s, 0.01,
                  kLongestPeriodS);
      },
      options, ParameterChange::kNever);
  add_own(add_source, options.source, ParameterChange::kNever);
  add_keys(odometry_keys(options.config), ParameterChange::kAtReset);
}

const NodeParameter& NodeParameters::at(const std::string& given) const {
  const std::string name(without_expert(given));
  const auto found = std::find_if(all_.begin(), all_.end(), [&](const auto& known) { return known.name() == name; });
  if (found != all_.end()) return *found;
  std::vector<std::string> names;
  for (const NodeParameter& known : all_) names.push_back(known.name());
  const std::string nearest = nearest_word(name, names);
  refuse(given, "the name of a parameter" + (nearest.empty() ? nearest : ", perhaps " + nearest));
}

NodeOptions node_options(const std::map<std::string, ParameterValue>& given) {
  NodeOptions options;
  for (const char* name : {"config", "calibration"}) {
    const auto file = given.find(name);
    if (file != given.end()) NodeParameters(options).at(name).set(file->second);
  }
  if (!options.config_file.empty()) options.config = load_config(options.config_file);
  if (!options.calibration_file.empty()) options.calibration = load_calibration(options.calibration_file);
  options = with_parameters(options, given);
  if (options.calibration) check_reading(*options.calibration, options.source.elevation_correction_deg);
  return options;
}

NodeOptions with_parameters(const NodeOptions& options, const std::map<std::string, ParameterValue>& changes) {
  NodeOptions changed = options;
  const NodeParameters parameters(changed);
  for (const auto& [name, value] : changes) {
    const NodeParameter& parameter = parameters.at(name);
    if (parameter.name() != name && changes.count(parameter.name()) > 0) refuse(name, "each key once");
    parameter.set(value);
  }
  changed.odom_frame = frame_name(changed.odom_frame);
  changed.base_frame = frame_name(changed.base_frame);
  if (changed.map_voxel_m > 0 && changed.map_voxel_m < ThinnedMap::kLeastVoxelM) {
    refuse("map_voxel", fmt::format("0 or at least {} m", ThinnedMap::kLeastVoxelM));
  }
  if (changed.odom_frame.empty()) refuse("odom_frame", "the name of a frame");
  if (changed.base_frame == changed.odom_frame) refuse("base_frame", "another frame than odom_frame");
  if (!changed.base_to_lidar.empty()) {
    pose_from_list(changed.base_to_lidar);
    if (changed.base_frame.empty()) refuse("base_frame", "the robot's frame, on which base_to_lidar places the LiDAR");
  }
  validate(changed.config);
  return changed;
}

SE3 pose_from_list(const std::vector<double>& v) {
  const bool finite = std::all_of(v.begin(), v.end(), [](double value) { return std::isfinite(value); });
  if ((v.size() != 6 && v.size() != 7) || !finite) {
    refuse("base_to_lidar", "a list of x, y, z, yaw, pitch, roll (m, rad) or x, y, z, qx, qy, qz, qw");
  }
  Eigen::Quaterniond q;
  if (v.size() == 6) {
    q = Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitX());
  } else {
    q = Eigen::Quaterniond(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1) > 1e-3) refuse("base_to_lidar", "a quaternion of length 1");
  }
  SE3 T = SE3::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() << v[0], v[1], v[2];
  return T;
}

}  // namespace rilo
