// config/default.yaml and docs/configuration.md say what the program does.
#include <filesystem>
#include <string>

#include "io/io_test_util.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo::test {
namespace {

const std::filesystem::path kSource = RILO_SOURCE_DIR;

TEST(CommittedFiles, default_yaml_is_the_dump_of_the_defaults) {
  EXPECT_EQ(slurp(kSource / "config/default.yaml"), dump_config(OdometryConfig{}))
      << "renew it: rilo config --dump > config/default.yaml";
}

TEST(CommittedFiles, default_yaml_loads_as_the_defaults) {
  EXPECT_EQ(dump_config(load_config(kSource / "config/default.yaml")), dump_config(OdometryConfig{}));
}

TEST(CommittedFiles, the_table_of_the_documentation_is_the_printed_one) {
  const std::string page = slurp(kSource / "docs/configuration.md");
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
}  // namespace rilo::test
