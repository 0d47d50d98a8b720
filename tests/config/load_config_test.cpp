// Round trip, and what is said about a wrong configuration.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/io_test_util.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string config_message(const std::string& yaml) {
  try {
    parse_config(yaml, "my.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

std::string override_message(const std::vector<std::string>& overrides) {
  try {
    with_overrides({}, overrides);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LoadConfig, nothing_said_means_the_defaults) {
  const std::string defaults = dump_config({});
  for (const char* yaml : {"", "\n\n", "# only a comment\n", "---\n", "---\n...\n", "{}", "~"}) {
    EXPECT_EQ(dump_config(parse_config(yaml, "empty")), defaults) << yaml;
  }
}

TEST(LoadConfig, a_part_of_the_keys_changes_that_part_of_the_base) {
  OdometryConfig base;
  base.map.levels = 3;
  base.icp.gate = 2.5;
  const OdometryConfig config = parse_config("icp:\n  gate: 4\nthreads: 2\n", "part", base);
  EXPECT_EQ(config.icp.gate, 4.0);
  EXPECT_EQ(config.threads, 2);
  EXPECT_EQ(config.map.levels, 3);
}

TEST(LoadConfig, dotted_keys_are_keys) { EXPECT_EQ(parse_config("icp.gate: 4", "dotted").icp.gate, 4.0); }

TEST(LoadConfig, a_word_may_stand_in_quotes) {
  EXPECT_EQ(parse_config("initial_pose: {rule: \"fixed_tau\"}", "quotes").initial_pose.rule,
            InitialPoseRule::kFixedTau);
  EXPECT_EQ(parse_config("initial_pose: {rule: 'map_score'}", "quotes").initial_pose.rule, InitialPoseRule::kMapScore);
}

TEST(LoadConfig, expert_keys_are_taken_with_and_without_their_heading) {
  const OdometryConfig config =
      parse_config("icp: {noise_m: 0.03}\nexpert:\n  icp: {gate: 4}\n  map: {levels: 3}\n", "expert");
  EXPECT_EQ(config.icp.gate, 4.0);
  EXPECT_EQ(config.icp.noise_m, 0.03);
  EXPECT_EQ(config.map.levels, 3);
  EXPECT_EQ(with_overrides({}, {"expert.icp.gate=5"}).icp.gate, 5.0);
  EXPECT_THAT(config_message("icp: {gate: 2}\nexpert: {icp: {gate: 3}}"), HasSubstr("icp.gate is given a second time"));
  EXPECT_THAT(config_message("expert: {icp: {gat: 3}}"), HasSubstr("Did you mean icp.gate?"));
  EXPECT_THAT(config_message("expert: {expert: {icp: {gate: 3}}}"), HasSubstr("unknown key"));
  EXPECT_THAT(config_message("expert: 3"), HasSubstr("a map of keys"));
}

TEST(LoadConfig, a_dump_shows_the_keys_of_users_before_the_expert_ones) {
  const std::string text = dump_config({});
  const std::size_t expert = text.find("\nexpert:\n");
  ASSERT_NE(expert, std::string::npos);
  EXPECT_LT(text.find("max_range_m:"), expert);
  EXPECT_GT(text.find("    gate:"), expert);
}

TEST(LoadConfig, a_dump_loads_as_exactly_the_same_numbers) {
  OdometryConfig config;
  config.icp.damping = 1e-9 / 3;
  config.icp.gate = std::nextafter(3.0, 4.0);
  config.map.voxel_m = 0.1 + 0.2;
  config.preprocess.max_range_m = 1000.0 / 7;
  config.icp.epsilon = 5e-324;
  config.threads = 1024;
  config.initial_pose.rule = InitialPoseRule::kFixedTau;
  config.coarse.always = true;
  const std::string text = dump_config(config);
  const OdometryConfig back = parse_config(text, "dump");
  EXPECT_EQ(back.icp.damping, config.icp.damping);
  EXPECT_EQ(back.icp.gate, config.icp.gate);
  EXPECT_EQ(back.map.voxel_m, config.map.voxel_m);
  EXPECT_EQ(back.preprocess.max_range_m, config.preprocess.max_range_m);
  EXPECT_EQ(back.icp.epsilon, config.icp.epsilon);
  EXPECT_EQ(back.threads, 1024);
  EXPECT_EQ(back.initial_pose.rule, InitialPoseRule::kFixedTau);
  EXPECT_TRUE(back.coarse.always);
  EXPECT_EQ(dump_config(back), text);
}

TEST(LoadConfig, an_unknown_key_names_its_place_and_the_nearest_known_one) {
  EXPECT_THAT(config_message("threads: 1\nicp:\n  max_iteration: 3\n"),
              AllOf(HasSubstr("my.yaml"), HasSubstr("line 3, column 3"), HasSubstr("icp.max_iteration"),
                    HasSubstr("Did you mean icp.max_iterations?")));
  EXPECT_THAT(config_message("thread: 1\n"), HasSubstr("Did you mean threads?"));
  EXPECT_THAT(config_message("registration:\n  score_sigma_m: 1\n"), HasSubstr("unknown key"));
  EXPECT_THAT(config_message("max_range_m: 50\n"), HasSubstr("Did you mean preprocess.max_range_m?"));
}

TEST(LoadConfig, a_key_given_twice_is_refused_whichever_way_it_is_written) {
  EXPECT_THAT(config_message("icp:\n  gate: 2\n  gate: 3\n"),
              AllOf(HasSubstr("line 3, column 3"), HasSubstr("icp.gate")));
  EXPECT_THAT(config_message("icp:\n  gate: 2\nicp:\n  damping: 0\n"), AllOf(HasSubstr("line 3"), HasSubstr("second")));
  EXPECT_THAT(config_message("icp:\n  gate: 2\nicp.gate: 3\n"), AllOf(HasSubstr("line 3"), HasSubstr("second")));
}

TEST(LoadConfig, a_wrong_type_says_what_was_found_and_what_is_expected) {
  EXPECT_THAT(config_message("icp:\n  gate: wide\n"),
              AllOf(HasSubstr("line 2, column 9"), HasSubstr("\"wide\""), HasSubstr("a number from 0.1 to 100")));
  EXPECT_THAT(config_message("threads: 1.5"), HasSubstr("a whole number from 0 to 1024"));
  EXPECT_THAT(config_message("preprocess: {deskew: yes}"), HasSubstr("true or false"));
  EXPECT_THAT(config_message("preprocess: {deskew: 1}"), HasSubstr("true or false"));
  EXPECT_THAT(config_message("initial_pose: {rule: best}"), HasSubstr("fixed_tau or map_score"));
  EXPECT_THAT(config_message("threads: \"2\""), HasSubstr("quotes"));
  EXPECT_THAT(config_message("threads: [2]"), HasSubstr("a list"));
  EXPECT_THAT(config_message("threads: {a: 2}"), HasSubstr("a map"));
  EXPECT_THAT(config_message("threads:\n"), HasSubstr("no value"));
  EXPECT_THAT(config_message("icp: 3"), HasSubstr("a map of keys"));
  EXPECT_THAT(config_message("[1, 2]"), HasSubstr("a map of keys"));
  EXPECT_THAT(config_message("just words"), HasSubstr("a map of keys"));
}

TEST(LoadConfig, numbers_out_of_range_and_nan_are_refused) {
  EXPECT_THAT(config_message("icp: {max_iterations: 0}"), HasSubstr("1 to 1000"));
  EXPECT_THAT(config_message("icp: {gate: -1}"), HasSubstr("0.1 to 100"));
  for (const char* value : {".nan", "nan", ".NaN", ".inf", "-.inf", "inf", "1e400"}) {
    EXPECT_THAT(config_message(std::string("icp: {gate: ") + value + "}"), HasSubstr("icp.gate")) << value;
  }
}

TEST(LoadConfig, values_that_contradict_each_other_are_refused) {
  EXPECT_THAT(config_message("preprocess: {min_range_m: 60, max_range_m: 50}"),
              AllOf(HasSubstr("my.yaml"), HasSubstr("max_range_m"), HasSubstr("line 1, column 31")));
  EXPECT_THAT(config_message("threads: 1\npreprocess:\n  min_range_m: 160\n"),
              AllOf(HasSubstr("max_range_m"), HasSubstr("line 3, column 3")));
  EXPECT_THAT(override_message({"map.max_points=4"}), HasSubstr("map.max_points"));
  EXPECT_EQ(override_message({"map.max_points=4", "map.min_points=3"}), "accepted");
}

TEST(LoadConfig, a_calibration_is_no_configuration) {
  EXPECT_THAT(config_message("recordings: []\nelevation_offset_deg: 0\nbeams: []\n"),
              AllOf(HasSubstr("the calibration of a sensor"), HasSubstr("--calibration")));
}

TEST(LoadConfig, text_that_is_no_yaml_or_more_than_one_document_is_refused_with_its_place) {
  EXPECT_THAT(config_message("icp: {gate: 3\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(config_message("a: b: c"), AllOf(HasSubstr("my.yaml"), HasSubstr("line 1")));
  EXPECT_THAT(config_message("threads: 1\n---\nthreads: 2\n"),
              AllOf(HasSubstr("second document"), HasSubstr("line 2, column 1")));
}

TEST(Overrides, the_last_one_wins_and_mistakes_name_the_option) {
  EXPECT_EQ(with_overrides({}, {"threads=1", "threads=2"}).threads, 2);
  EXPECT_THAT(override_message({"threads"}), HasSubstr("key=value"));
  EXPECT_THAT(override_message({"voxel_size=3"}), HasSubstr("map.voxel_m"));
  EXPECT_THAT(override_message({"icp.foo=3"}), HasSubstr("Did you mean icp."));
  EXPECT_THAT(override_message({"=3"}), HasSubstr("unknown key"));
  EXPECT_THAT(override_message({"icp=3"}), HasSubstr("\"icp\" is a section; expected one of its keys, \"icp.KEY\""));
  EXPECT_THAT(override_message({"icp.gat=3"}), HasSubstr("Did you mean icp.gate?"));
  EXPECT_THAT(override_message({"icp.gate="}), HasSubstr("icp.gate"));
  EXPECT_THAT(override_message({"icp.gate=nan"}), HasSubstr("a number from 0.1 to 100"));
}

TEST(Overrides, may_put_right_what_a_file_alone_contradicts) {
  const test::TempDir folder;
  const auto far = folder.write("far.yaml", "preprocess: {min_range_m: 150}\n");
  EXPECT_EQ(load_config(far, {"preprocess.max_range_m=200"}).preprocess.max_range_m, 200.0);
  EXPECT_EQ(load_config("", {"threads=3"}).threads, 3);
  try {
    load_config(far, {"threads=3"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("far.yaml, line 1, column 14"), HasSubstr("preprocess.max_range_m is 100"),
                      HasSubstr("preprocess.min_range_m, 150")));
  }
}

TEST(Overrides, that_contradict_each_other_are_no_fault_of_the_file) {
  const test::TempDir folder;
  const auto file = folder.write("gate.yaml", "icp: {gate: 4}\n");
  try {
    load_config(file, {"preprocess.max_range_m=2", "preprocess.min_range_m=5"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("--set"), HasSubstr("preprocess.max_range_m is 2"), Not(HasSubstr("gate.yaml"))));
  }
}

TEST(LoadConfig, a_file_that_is_missing_or_a_folder_is_refused_by_name) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir());
  EXPECT_THROW(load_config(folder / "no_such_configuration.yaml"), ConfigError);
  EXPECT_THROW(load_config(folder), ConfigError);
}

}  // namespace
}  // namespace rilo
