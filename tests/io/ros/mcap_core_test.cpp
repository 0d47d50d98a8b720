// MCAP files by the npm package @mcap/core. Those in fixtures/ are by version 2.2.2, by
//   npm install @mcap/core @foxglove/wasm-zstd lz4js && node write_mcap.cjs node_modules fixtures
// With the environment variable RILO_NODE_MODULES, a node_modules folder, new ones are written and read, too.
#include <cstdlib>

#include "io/io_test_util.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

void expect_all(const fs::path& folder) {
  for (const char* name : {"none", "unchunked", "no_index", "zstd", "lz4"}) {
    SCOPED_TRACE(name);
    const auto source = open_scan_source(folder / (std::string(name) + ".mcap"));
    EXPECT_EQ(source->size(), 5U);
    for (int i = 0; i < 5; ++i) {
      const auto sweep = source->next();
      ASSERT_TRUE(sweep);
      EXPECT_EQ(sweep->stamp_ns, 1'700'000'000'000'000'000 + 100'000'000 * i);
      ASSERT_EQ(sweep->points.size(), 10U);
      EXPECT_EQ(sweep->points[3], Eigen::Vector3f(static_cast<float>(i) + 0.5F, 3, -3));
      EXPECT_FLOAT_EQ(sweep->times_s[3], 0.03F);
    }
    EXPECT_FALSE(source->next());
    EXPECT_EQ(source->info().point_times, "field t (uint32), ns since the sweep's stamp");
    EXPECT_EQ(source->info().frame_id, "os_sensor");
    EXPECT_TRUE(source->info().warnings.empty());
  }
}

TEST(McapCoreTest, ChunkedAndUnchunkedWithEveryCompression) { expect_all(RILO_SOURCE_DIR "/tests/io/ros/fixtures"); }

TEST(McapCoreTest, WrittenAnew) {
  const char* modules = std::getenv("RILO_NODE_MODULES");
  if (modules == nullptr) GTEST_SKIP() << "RILO_NODE_MODULES is not set";
  const TempDir folder;
  const std::string command = "node '" RILO_SOURCE_DIR "/tests/io/ros/write_mcap.cjs' '" + std::string(modules) +
                              "' '" + folder.path().string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  expect_all(folder.path());
}

}  // namespace
}  // namespace rilo::test
