// The table of the nodes' parameters: values, ranges, what is refused and with which words.
#include "rilo/node/node_parameters.hpp"

#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

using test::TempDir;
using testing::HasSubstr;

template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

TEST(NodeParameters, EveryKeyOfTheConfigurationIsThereOnce) {
  NodeOptions options;
  std::set<std::string> names;
  const NodeParameters parameters(options);
  for (const NodeParameter& parameter : parameters.all()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name() << " twice";
    EXPECT_FALSE(parameter.meaning().empty()) << parameter.name();
    EXPECT_FALSE(parameter.expected().empty()) << parameter.name();
  }
  OdometryConfig config;
  const ConfigKeys keys = odometry_keys(config);
  for (const ConfigSection& section : keys.sections()) {
    for (const ConfigKey& key : section.keys) EXPECT_EQ(names.count(key.name()), 1U) << key.name();
  }
}

TEST(NodeParameters, EveryValueCanBeReadAndSetAgain) {
  NodeOptions options;
  const NodeParameters parameters(options);
  for (const NodeParameter& parameter : parameters.all()) {
    const ParameterValue value = parameter.value();
    parameter.set(value);
    EXPECT_EQ(parameter.value(), value) << parameter.name();
  }
}

TEST(NodeParameters, ValuesReachTheirMembers) {
  const NodeOptions options = node_options({{"queue", std::int64_t{0}},
                                            {"odom_frame", "world"},
                                            {"publish_tf", false},
                                            {"path_period", std::int64_t{3}},
                                            {"point_times", "azimuth"},
                                            {"base_frame", "base_link"},
                                            {"base_to_lidar", std::vector<double>{1, 2, 3, 0, 0, 0}},
                                            {"icp.max_iterations", std::int64_t{7}},
                                            {"map.voxel_m", 0.7}});
  EXPECT_EQ(options.queue, 0);
  EXPECT_EQ(options.odom_frame, "world");
  EXPECT_FALSE(options.publish_tf);
  EXPECT_EQ(options.path_period_s, 3);
  EXPECT_EQ(options.source.point_times, PointTimes::kAzimuth);
  EXPECT_EQ(pose_from_list(options.base_to_lidar).translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(options.config.icp.max_iterations, 7);
  EXPECT_EQ(options.config.map.voxel_m, 0.7);
}

TEST(NodeParameters, SingleKeysCountMoreThanTheFile) {
  const TempDir folder;
  const std::string file = folder.write("config.yaml", "map:\n  voxel_m: 0.7\nicp:\n  max_iterations: 5\n").string();
  const NodeOptions options = node_options({{"config", file}, {"icp.max_iterations", std::int64_t{7}}});
  EXPECT_EQ(options.config.map.voxel_m, 0.7);
  EXPECT_EQ(options.config.icp.max_iterations, 7);
  EXPECT_THROW(node_options({{"config", "nowhere.yaml"}}), IoError);
}

// `rosparam load` of what `rilo config --dump` writes gives them all.
TEST(NodeParameters, KeysHaveTheNamesOfAFileToo) {
  const NodeOptions options = node_options({{"expert.icp.gate", 3.5}, {"expert.map.voxel_m", 0.7}});
  EXPECT_EQ(options.config.icp.gate, 3.5);
  EXPECT_EQ(options.config.map.voxel_m, 0.7);
  EXPECT_THAT(refusal([] { node_options({{"expert.icp.gate", 3.5}, {"icp.gate", 3.5}}); }), HasSubstr("once"));
  EXPECT_THAT(refusal([] { node_options({{"expert.icp.gat", 3.5}}); }), HasSubstr("expert.icp.gat: expected"));
}

TEST(NodeParameters, TheCalibrationIsLoaded) {
  const TempDir folder;
  const std::string file =
      folder
          .write("c.yaml", "elevation_correction_deg: 0.1\nelevation_offset_deg: 0.2\nbeams: [[3, -5, 0.01, 0]]\n...\n")
          .string();
  const NodeOptions options =
      node_options({{"calibration", file}, {"icp.max_iterations", std::int64_t{7}}, {"elevation_correction", 0.1}});
  ASSERT_TRUE(options.calibration);
  EXPECT_NEAR(options.calibration->elevation_offset_rad, 0.00349, 1e-5);
  EXPECT_EQ(options.calibration->beams.at(0).beam, 3);
  EXPECT_THAT(refusal([&] {
                node_options({{"calibration", file}});
              }),
              HasSubstr(file + ": learnt from data read with an elevation correction of 0.1 deg"));
  EXPECT_FALSE(node_options({{"calibration", ""}}).calibration);
  EXPECT_THROW(node_options({{"calibration", "nowhere.yaml"}}), IoError);
}

TEST(NodeParameters, WhatIsWrongIsNamed) {
  EXPECT_THAT(refusal([] {
                node_options({{"queue", std::int64_t{-1}}});
              }),
              HasSubstr("parameter queue: expected a whole number from 0 to 100000, found -1"));
  EXPECT_THAT(refusal([] { node_options({{"publish_tf", "perhaps"}}); }), HasSubstr("expected true or false"));
  EXPECT_THAT(refusal([] { node_options({{"point_times", "never"}}); }), HasSubstr("auto or none or azimuth"));
  EXPECT_THAT(refusal([] { node_options({{"odom_frame", ""}}); }), HasSubstr("odom_frame"));
  EXPECT_THAT(refusal([] { node_options({{"odom_frame", "/"}}); }), HasSubstr("odom_frame"));
  EXPECT_THAT(refusal([] { node_options({{"base_frame", "/odom"}}); }), HasSubstr("another frame than odom_frame"));
  EXPECT_THAT(refusal([] { node_options({{"odom_frame", 3.0}}); }), HasSubstr("a text"));
  EXPECT_THAT(refusal([] {
                node_options({{"base_to_lidar", std::vector<double>{1, 2}}});
              }),
              HasSubstr("a list of x, y, z"));
  EXPECT_THAT(refusal([] {
                node_options({{"base_to_lidar", std::vector<double>{0, 0, 0, 0, 0, 0, 2}}});
              }),
              HasSubstr("length 1"));
  EXPECT_THAT(refusal([] {
                node_options({{"base_to_lidar", std::vector<double>{0, 0, 1, 0, 0, 0}}});
              }),
              HasSubstr("parameter base_frame: expected the robot's frame"));
  EXPECT_THAT(refusal([] { node_options({{"icp.max_iteration", std::int64_t{7}}}); }), HasSubstr("icp.max_iterations"));
  EXPECT_THAT(refusal([] { node_options({{"odomframe", "world"}}); }), HasSubstr("odom_frame"));
  // Each in its range, but not together.
  EXPECT_THAT(refusal([] {
                node_options({{"preprocess.min_range_m", 90.0}, {"preprocess.max_range_m", 10.0}});
              }),
              HasSubstr("range_m"));
}

TEST(NodeParameters, ChangesAreTakenTogetherOrNotAtAll) {
  const NodeOptions before = node_options({{"path_period", 2.0}});
  const NodeOptions after = with_parameters(before, {{"path_period", 3.0}, {"icp.max_iterations", std::int64_t{7}}});
  EXPECT_EQ(after.path_period_s, 3);
  EXPECT_EQ(after.config.icp.max_iterations, 7);
  EXPECT_EQ(before.path_period_s, 2);
  EXPECT_THAT(refusal([&] {
                with_parameters(before, {{"path_period", 3.0}, {"local_map_period", -1.0}});
              }),
              HasSubstr("local_map_period"));
}

TEST(NodeParameters, AMapHasVoxelsOrNone) {
  EXPECT_EQ(node_options({{"map_voxel", 0.0}}).map_voxel_m, 0.0);
  EXPECT_EQ(node_options({{"map_voxel", 0.001}}).map_voxel_m, 0.001);
  EXPECT_THAT(refusal([] { node_options({{"map_voxel", 1e-4}}); }), HasSubstr("map_voxel: expected 0 or at least"));
}

TEST(NodeParameters, AnglesOfAListAreYawPitchRoll) {
  const SE3 T = pose_from_list({1, 2, 3, 0.4, 0.02, -0.01});
  const Eigen::Quaterniond q(T.linear());
  const SE3 same = pose_from_list({1, 2, 3, q.x(), q.y(), q.z(), q.w()});
  EXPECT_TRUE(T.isApprox(same, 1e-12));
  EXPECT_NEAR(std::atan2(T(1, 0), T(0, 0)), 0.4, 1e-12);
  // A quaternion's length may be off by a thousandth, and is made good.
  const Eigen::Matrix3d R = pose_from_list({1, 2, 3, 0, 0, 0.6005, 0.8006}).linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  for (const double w : {0.79, 0.81, std::nan("")}) {
    EXPECT_THROW(pose_from_list({1, 2, 3, 0, 0, 0.6, w}), std::invalid_argument) << w;
    EXPECT_THROW(pose_from_list({w, 2, 3, 0, 0}), std::invalid_argument);
  }
  EXPECT_THROW(pose_from_list({std::nan(""), 2, 3, 0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace rilo
