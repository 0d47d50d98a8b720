#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::test {
namespace {

TEST(BinTest, KittiRoundTrip) {
  const TempDir folder;
  const Sweep sweep = small_sweep();
  write_kitti_bin(folder / "a.bin", sweep);
  expect_same(read_bin(folder / "a.bin"), sweep, false);
}

TEST(BinTest, ColumnsAsTold) {
  const TempDir folder;
  const auto file =
      folder.write("a.bin", bytes_of<float>({9, 1, 2, 3, 0.5F, 0.04F, 7, 9, 4, 5, 6, 0.25F, 0.08F, 70000}));
  const RawCloud cloud = read_bin(file, "_, X, y,z , intensity,t,ring");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5F, 0.25F}));
  EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{7, 65535}));
  ASSERT_TRUE(cloud.times);
  EXPECT_FLOAT_EQ(static_cast<float>(cloud.times->floats[1]), 0.08F);
}

TEST(BinTest, SenselessColumns) {
  const TempDir folder;
  const auto file = folder.write("a.bin", "");
  for (const char* fields : {"", "x,y", "x,y,z,", "x,y,z,x", "x,y,z,colour", "x y z"}) {
    EXPECT_THROW(read_bin(file, fields), std::invalid_argument) << fields;
  }
}

TEST(BinTest, OddSizes) {
  const TempDir folder;
  EXPECT_TRUE(read_bin(folder.write("empty.bin", "")).points.empty());
  for (std::size_t rest = 1; rest < 16; ++rest) {
    const auto file = folder.write("a.bin", std::string(32 + rest, '\0'));
    expect_io_error([&] { read_bin(file); },
                    {"a.bin", "byte 32", std::to_string(32 + rest) + " bytes", "records of 16 bytes", "bin_fields"});
  }
  const auto nuscenes = folder.write("n.bin", std::string(60, '\0'));
  expect_io_error([&] { read_bin(nuscenes); }, {"would fit records of 3, 5 columns"});
  EXPECT_EQ(read_bin(nuscenes, "x,y,z,intensity,ring").points.size(), 3U);
}

TEST(BinTest, AbsurdCoordinatesAreAWrongFormat) {
  const TempDir folder;
  const auto file = folder.write("a.bin", bytes_of<float>({1e30F, 0, 0, 0, 1, 1, 1, 1}));
  expect_io_error([&] { read_bin(file); }, {"1 of 2 points", "bin_fields", "not float32"});
}

TEST(BinTest, InfiniteCoordinatesAreNoReturns) {
  const TempDir folder;
  constexpr float kInf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(read_bin(folder.write("a.bin", bytes_of<float>({kInf, kInf, -kInf, 0, 1, 1, 1, 1}))).points.size(), 2U);
}

TEST(BinTest, NanPointsAreKept) {
  const TempDir folder;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto file = folder.write("a.bin", bytes_of<float>({kNan, kNan, kNan, 1, kNan, 2, 3, 1}));
  const RawCloud cloud = read_bin(file);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_TRUE(std::isnan(cloud.points[0].x()));
}

TEST(BinTest, NotAFile) {
  const TempDir folder;
  expect_io_error([&] { read_bin(folder.path()); }, {"it is a folder"});
  expect_io_error([&] { read_bin(folder / "none.bin"); }, {"none.bin", "No such file"});
  expect_io_error([&] { read_bin("/dev/null"); }, {"not a regular file"});
}

}  // namespace
}  // namespace rilo::test
