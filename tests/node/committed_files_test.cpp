// The parameter file and the launch file of ros2/, which no ROS 2 reads here, against the table of parameters.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "rilo/node/node_parameters.hpp"

namespace rilo {
namespace {

const std::filesystem::path kRos2 = std::filesystem::path(RILO_SOURCE_DIR) / "ros2";

// As ROS 2 reads YAML: what stands in quotes is text.
ParameterValue scalar_of(const YAML::Node& node) {
  bool flag = false;
  std::int64_t whole = 0;
  double number = 0;
  if (node.Tag() == "!") return node.Scalar();
  if (YAML::convert<bool>::decode(node, flag)) return flag;
  if (YAML::convert<std::int64_t>::decode(node, whole)) return whole;
  if (YAML::convert<double>::decode(node, number)) return number;
  return node.Scalar();
}

void flatten(const YAML::Node& map, const std::string& prefix, std::map<std::string, ParameterValue>& into) {
  for (const auto& entry : map) {
    const std::string name = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap()) {
      flatten(entry.second, name + ".", into);
    } else if (entry.second.IsSequence()) {
      into[name] = entry.second.as<std::vector<double>>();
    } else {
      into[name] = scalar_of(entry.second);
    }
  }
}

std::map<std::string, ParameterValue> parameters_in(const std::string& yaml) {
  std::map<std::string, ParameterValue> given;
  flatten(YAML::Load(yaml)["/**"]["ros__parameters"], "", given);
  return given;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Ros2Files, TheParameterFileHoldsTheDefaults) {
  const auto given = parameters_in(text_of(kRos2 / "config" / "odometry.yaml"));
  EXPECT_GE(given.size(), 12U);
  NodeOptions defaults;
  const NodeParameters table(defaults);
  NodeOptions options = node_options(given);
  const NodeParameters read(options);
  for (const auto& [name, value] : given) EXPECT_EQ(read.at(name).value(), table.at(name).value()) << name;
}

// What it shows as an example, too.
TEST(Ros2Files, TheParameterFileCanBeUncommented) {
  const std::string text = text_of(kRos2 / "config" / "odometry.yaml");
  auto given = parameters_in(std::regex_replace(text, std::regex("# (base_to_lidar|config|calibration):"), "$1:"));
  for (const char* file : {"config", "calibration"}) EXPECT_EQ(given.erase(file), 1U);  // that is not there
  given["base_frame"] = "base_link";
  EXPECT_EQ(pose_from_list(node_options(given).base_to_lidar).translation().z(), 1.7);
}

TEST(Ros2Files, TheLaunchFileSetsParametersThatAreThere) {
  const std::string text = text_of(kRos2 / "launch" / "odometry.launch.py");
  const std::size_t begin = text.find("PARAMETERS = {");
  ASSERT_NE(begin, std::string::npos);
  const std::string table_text = text.substr(begin, text.find("\n}", begin) - begin);
  const std::regex entry("\"(\\w+)\": \\((str|int|flag),");
  NodeOptions options;
  const NodeParameters table(options);
  std::size_t count = 0;
  for (std::sregex_iterator it(table_text.begin(), table_text.end(), entry), end; it != end; ++it) {
    ++count;
    const std::string name = (*it)[1];
    if (name == "use_sim_time") continue;  // ROS' own
    const ParameterValue value = table.at(name).value();
    const std::string kind = (*it)[2];
    EXPECT_EQ(std::holds_alternative<bool>(value), kind == "flag") << name;
    EXPECT_EQ(std::holds_alternative<std::int64_t>(value), kind == "int") << name;
    EXPECT_EQ(std::holds_alternative<std::string>(value), kind == "str") << name;
  }
  EXPECT_GE(count, 5U);
}

}  // namespace
}  // namespace rilo
