// Every field is a key, and every key reaches its own field.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/field_count.hpp"
#include "config/nearest_word.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

std::vector<ConfigKey> all_keys(const ConfigKeys& keys) {
  std::vector<ConfigKey> all;
  for (const ConfigSection& section : keys.sections()) all.insert(all.end(), section.keys.begin(), section.keys.end());
  return all;
}

// Another allowed value, near the present one so that it stays in agreement with the other keys.
std::string other_value(const ConfigKey& key) {
  if (const auto* real = std::get_if<ConfigKey::Real>(&key.binding())) {
    const double now = *real->member;
    const double up = now + 0.001 * (now + 1e-3);
    return std::to_string(up <= real->most ? up : now * 0.999);
  }
  if (const auto* integer = std::get_if<ConfigKey::Integer>(&key.binding())) {
    return std::to_string(*integer->member + (*integer->member < integer->most ? 1 : -1));
  }
  if (std::holds_alternative<ConfigKey::Boolean>(key.binding())) return key.value() == "true" ? "false" : "true";
  const auto& choice = std::get<ConfigKey::Choice>(key.binding());
  return choice.words.at((choice.get() + 1) % choice.words.size());
}

std::map<std::string, std::string> values_of(OdometryConfig config) {
  std::map<std::string, std::string> values;
  for (const ConfigKey& key : all_keys(odometry_keys(config))) values[key.name()] = key.value();
  return values;
}

// A part of a name in the wrong section counts one more than the same part elsewhere.
TEST(ConfigKeys, NearestOfNamesInAndOutOfSections) {
  double value = 0;
  ConfigKeys keys;
  keys.real({"gates", "", "", ""}, value, 0, 1);
  keys.section("other", "");
  keys.real({"gate", "", "", ""}, value, 0, 1);
  EXPECT_EQ(keys.nearest("gate"), "gates or other.gate");
  EXPECT_EQ(keys.nearest("other.gat"), "other.gate");
  EXPECT_NE(keys.find("expert.other.gate"), nullptr);
  EXPECT_EQ(keys.find("expert-other.gate"), nullptr);
}

TEST(NearestWord, DiffersInHalfOfItsLettersAtMost) {
  EXPECT_EQ(nearest_word("abcd", {"wxyz", "abyz"}), "abyz");
  EXPECT_EQ(nearest_word("abcd", {"wxyz", "axyz"}), "");
  EXPECT_EQ(nearest_word("abcd", {"abyz", "abcdefghijkl"}), "abcdefghijkl");
}

TEST(ConfigKeys, every_field_of_every_stage_has_a_key) {
  OdometryConfig config;
  const ConfigKeys keys = odometry_keys(config);
  std::map<std::string, std::size_t> counts;
  for (const ConfigSection& section : keys.sections()) counts[section.name] += section.keys.size();
  EXPECT_EQ(counts["preprocess"], field_count<PreprocessConfig>());
  EXPECT_EQ(counts["coarse"], field_count<CoarseRegistrationConfig>());
  EXPECT_EQ(counts["prediction"], field_count<MotionPredictionConfig>());
  EXPECT_EQ(counts["prior"], field_count<MotionPriorConfig>());
  EXPECT_EQ(counts["initial_pose"], field_count<InitialPoseConfig>());
  EXPECT_EQ(counts["threshold"], field_count<AdaptiveThresholdConfig>());
  EXPECT_EQ(counts["icp"], field_count<AdaptiveIcpConfig>());
  EXPECT_EQ(counts["map"], field_count<LocalMapConfig>());
  EXPECT_EQ(counts["elevation"], field_count<ElevationOffsetConfig>());
  EXPECT_EQ(counts["health"], field_count<HealthConfig>());
  EXPECT_EQ(counts[""], 1U);                                         // threads
  EXPECT_EQ(keys.sections().size(), field_count<OdometryConfig>());  // a stage each, and the section of threads
}

TEST(ConfigKeys, names_are_unique_and_each_has_a_meaning) {
  OdometryConfig config;
  std::set<std::string> names;
  for (const ConfigKey& key : all_keys(odometry_keys(config))) {
    EXPECT_TRUE(names.insert(key.name()).second) << key.name();
    EXPECT_FALSE(key.meaning().empty()) << key.name();
    EXPECT_EQ(key.meaning().find('|'), std::string::npos) << key.name() << ": the documentation's table would break";
  }
}

TEST(ConfigKeys, the_default_of_every_key_is_allowed) {
  OdometryConfig config;
  for (const ConfigKey& key : all_keys(odometry_keys(config))) EXPECT_TRUE(key.set(key.value())) << key.name();
}

TEST(ConfigKeys, setting_a_key_changes_that_key_alone) {
  OdometryConfig defaults;
  const auto before = values_of(defaults);
  for (const ConfigKey& key : all_keys(odometry_keys(defaults))) {
    const std::string value = other_value(key);
    auto after = values_of(with_overrides(OdometryConfig{}, {key.name() + "=" + value}));
    EXPECT_NE(after.at(key.name()), before.at(key.name())) << key.name() << '=' << value;
    after[key.name()] = before.at(key.name());
    EXPECT_EQ(after, before) << key.name();
  }
}

TEST(ConfigKeys, no_number_takes_nan_or_a_value_beyond_its_range) {
  OdometryConfig config;
  for (const ConfigKey& key : all_keys(odometry_keys(config))) {
    const std::string before = key.value();
    std::vector<std::string> wrong{"nan",   ".nan", "NaN", "-nan", "inf",  ".inf", "-inf",
                                   "1e999", "",     " ",   "1 2",  "0x10", "yes"};
    if (const auto* real = std::get_if<ConfigKey::Real>(&key.binding())) {
      wrong.push_back(std::to_string(real->least - 1));
      wrong.push_back(std::to_string(real->most * 2 + 1));
    }
    if (const auto* integer = std::get_if<ConfigKey::Integer>(&key.binding())) {
      wrong.push_back(std::to_string(integer->least - 1));
      wrong.push_back(std::to_string(integer->most + 1));
      wrong.push_back("99999999999999999999");
      wrong.push_back(std::to_string(integer->least) + ".5");
    }
    for (const std::string& text : wrong) EXPECT_FALSE(key.set(text)) << key.name() << " took \"" << text << '"';
    EXPECT_EQ(key.value(), before) << key.name();
  }
}

TEST(ConfigKeys, hand_picked_keys_reach_their_members) {
  const OdometryConfig config =
      with_overrides({}, {"threads=3", "preprocess.deskew=false", "icp.max_iterations=7", "map.voxel_m=0.125",
                          "initial_pose.rule=fixed_tau", "prior.enabled=false"});
  EXPECT_EQ(config.threads, 3);
  EXPECT_FALSE(config.preprocess.deskew);
  EXPECT_EQ(config.icp.max_iterations, 7);
  EXPECT_EQ(config.map.voxel_m, 0.125);
  EXPECT_EQ(config.initial_pose.rule, InitialPoseRule::kFixedTau);
  EXPECT_FALSE(config.prior.enabled);
  EXPECT_TRUE(config.prediction.enabled);
}

}  // namespace
}  // namespace rilo
