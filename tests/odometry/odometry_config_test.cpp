// No value of any key that is out of its range is let through, and none is used before it was checked.
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/odometry/odometry_keys.hpp"

namespace rilo {
namespace {

using ::testing::HasSubstr;

std::string message_of(const OdometryConfig& config) {
  try {
    validate(config);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "valid";
}

// Puts what is wrong into each key in turn.
class WrongValues : public KeyVisitor {
 public:
  explicit WrongValues(const OdometryConfig& config) : config_(config) {}

  void section(std::string_view name, std::string_view /*meaning*/) override { section_ = std::string(name) + "."; }
  void real(const KeyInfo& key, double& member, double least, double most) override {
    expect_refused(key, member, least - 1);
    expect_refused(key, member, 2 * most + 1);
    expect_refused(key, member, std::numeric_limits<double>::quiet_NaN());
    expect_refused(key, member, std::numeric_limits<double>::infinity());
  }
  void integer(const KeyInfo& key, int& member, int least, int most) override {
    expect_refused(key, member, least - 1);
    expect_refused(key, member, most + 1);
    expect_refused(key, member, std::numeric_limits<int>::max());
  }
  void boolean(const KeyInfo& /*key*/, bool& /*member*/) override { ++keys_; }
  void choice_of(const KeyInfo& /*key*/, KeyChoice choice) override {
    EXPECT_LT(choice.get(), choice.words.size());
    ++keys_;
  }

  int keys() const { return keys_; }

 private:
  template <typename Number>
  void expect_refused(const KeyInfo& key, Number& member, Number wrong) {
    const Number right = std::exchange(member, wrong);
    EXPECT_THAT(message_of(config_), HasSubstr(section_ + std::string(key.name) + " is ")) << wrong;
    member = right;
    ++keys_;
  }

  const OdometryConfig& config_;
  std::string section_;
  int keys_ = 0;
};

TEST(OdometryConfig, TheDefaultsAreValid) { EXPECT_EQ(message_of({}), "valid"); }

TEST(OdometryConfig, EveryKeyIsChecked) {
  OdometryConfig config;
  WrongValues wrong(config);
  visit_keys(config, wrong);
  EXPECT_GT(wrong.keys(), 200);
  EXPECT_EQ(message_of(config), "valid");
}

TEST(OdometryConfig, AChoiceThatIsNoneIsRefused) {
  OdometryConfig config;
  config.initial_pose.rule = static_cast<InitialPoseRule>(17);
  EXPECT_THAT(message_of(config),
              HasSubstr("initial_pose.rule is none of its values, expected fixed_tau or map_score"));
}

TEST(OdometryConfig, ValuesThatDependOnOneAnother) {
  OdometryConfig config;
  config.preprocess.min_range_m = 10;
  config.preprocess.max_range_m = 5;
  EXPECT_EQ(message_of(config),
            "configuration: preprocess.max_range_m is 5, expected at least that of preprocess.min_range_m, 10");
  config = {};
  config.map.min_points = 10;
  config.map.max_points = 9;
  EXPECT_THAT(message_of(config), HasSubstr("map.max_points is 9"));
  config = {};
  config.threshold.floor_m = 2;
  config.threshold.ceiling_m = 1;
  EXPECT_THAT(message_of(config), HasSubstr("threshold.ceiling_m is 1"));
  config = {};
  config.preprocess.min_voxel_m = 2;
  config.preprocess.max_voxel_m = 1;
  EXPECT_THAT(message_of(config), HasSubstr("preprocess.max_voxel_m is 1"));
}

TEST(OdometryConfig, NothingIsBuiltFromAnInvalidOne) {
  OdometryConfig config;
  config.map.levels = std::numeric_limits<int>::max();  // so many grids would take all memory there is
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
  config = {};
  config.threads = -1;
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
}

}  // namespace
}  // namespace rilo
