// Whatever the bytes, a configuration is loaded or refused with a ConfigError.
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
