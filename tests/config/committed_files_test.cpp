// config/default.yaml and docs/configuration.md say what the program does.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

const std::filesystem::path kSource = RILO_SOURCE_DIR;

std::string read_all(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream.good()) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CommittedFiles, default_yaml_is_the_dump_of_the_defaults) {
  EXPECT_EQ(read_all(kSource / "config/default.yaml"), dump_config(OdometryConfig{}))
      << "renew it: rilo config --dump > config/default.yaml";
}

TEST(CommittedFiles, default_yaml_loads_as_the_defaults) {
  EXPECT_EQ(dump_config(load_config(kSource / "config/default.yaml")), dump_config(OdometryConfig{}));
}

TEST(CommittedFiles, the_table_of_the_documentation_is_the_printed_one) {
  const std::string page = read_all(kSource / "docs/configuration.md");
  const std::string begin = "<!-- keys: begin -->\n";
  const std::string end = "<!-- keys: end -->\n";
  const std::size_t first = page.find(begin);
  const std::size_t last = page.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  ASSERT_LT(first, last);
  const std::size_t table = first + begin.size();
  EXPECT_EQ(page.substr(table, last - table), config_markdown(OdometryConfig{}))
      << "renew what stands between the markers: rilo config --dump --markdown";
}

}  // namespace
}  // namespace rilo
