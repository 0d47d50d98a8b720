// Whatever the bytes, a configuration is loaded or refused with a ConfigError.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

// True when it was taken. Any other exception fails the test by itself.
bool is_taken(const std::string& yaml) {
  try {
    validate(parse_config(yaml, "hostile"));
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

TEST(HostileConfig, every_beginning_of_a_dump) {
  const std::string text = dump_config({});
  std::size_t refused = 0;
  for (std::size_t length = 0; length < text.size(); length += 3) refused += is_taken(text.substr(0, length)) ? 0 : 1;
  EXPECT_GT(refused, 0U);
  EXPECT_TRUE(is_taken(text));
}

TEST(HostileConfig, a_dump_with_changed_bytes) {
  std::mt19937 random(1);
  const std::string text = dump_config({});
  for (int round = 0; round < 1000; ++round) {
    std::string broken = text;
    for (int i = 0; i < 3; ++i) broken[random() % broken.size()] = static_cast<char>(random() % 256);
    is_taken(broken);
  }
}

TEST(HostileConfig, random_bytes_and_random_yaml_signs) {
  std::mt19937 random(2);
  const std::string signs = "{}[]:,-?&*!|>'\"%@`#~ \n\tab01.\\";
  for (int round = 0; round < 5000; ++round) {
    std::string bytes(random() % 60, ' ');
    for (char& byte : bytes) byte = round % 2 == 0 ? static_cast<char>(random() % 256) : signs[random() % signs.size()];
    is_taken(bytes);
  }
}

TEST(HostileConfig, deep_nesting_aliases_tags_and_long_names) {
  EXPECT_FALSE(is_taken(std::string(100, '[')));
  EXPECT_FALSE(is_taken(std::string(20000, '[')));
  EXPECT_FALSE(is_taken(std::string(20000, '{')));
  std::string indented;
  for (int depth = 0; depth < 3000; ++depth) indented += std::string(static_cast<std::size_t>(depth), ' ') + "a:\n";
  EXPECT_FALSE(is_taken(indented));
  EXPECT_FALSE(is_taken("icp: &a {gate: *a}"));
  EXPECT_FALSE(is_taken("icp: &a {<<: *a}"));
  EXPECT_FALSE(is_taken("icp: *unknown"));
  EXPECT_FALSE(is_taken("? {a: b}\n: c"));
  EXPECT_FALSE(is_taken("!!binary x"));
  EXPECT_FALSE(is_taken(std::string(100000, 'k') + ": 1"));
  EXPECT_FALSE(is_taken(std::string("threads: 1\0", 11)));
}

}  // namespace
}  // namespace rilo
