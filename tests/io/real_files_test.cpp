// Files that other programs wrote, from ../shared/data; skipped where it is absent.
#include "io/real_files.hpp"

#include <algorithm>
#include <filesystem>

#include "io/io_test_util.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

// Sweeps of real sensors: some hundred metres around the sensor, most points measured.
void expect_plausible(const RawCloud& cloud) {
  std::size_t near = 0;
  for (const auto& point : cloud.points) near += point.allFinite() && point.norm() < 300 ? 1 : 0;
  EXPECT_GT(near, cloud.points.size() * 9 / 10);
}

TEST_F(RealFiles, Pcd) {
  const RawCloud ascii = read_pcd(file("pcd/ascii_robosense.pcd"));
  ASSERT_EQ(ascii.points.size(), 25322U);
  EXPECT_EQ(ascii.points[0], Eigen::Vector3f(3.26426F, -0.149672F, 0.745147F));
  EXPECT_EQ(ascii.intensities[0], 59);
  expect_plausible(ascii);
  const RawCloud padded = read_pcd(file("pcd/binary_padded_ring_hdl32.pcd"));
  ASSERT_EQ(padded.points.size(), 64545U);
  EXPECT_LE(*std::max_element(padded.rings.begin(), padded.rings.end()), 31);
  expect_plausible(padded);
  expect_plausible(read_pcd(file("pcd/fast_gicp_251370668.pcd")));
  for (const char* name : {"pcd/tiny_cloud-ascii.pcd", "pcd/tiny_cloud-binary.pcd"}) {
    EXPECT_EQ(read_pcd(file(name)).points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(1, 2, 3)}) << name;
  }
}

TEST_F(RealFiles, CompressedPcdWithAbsoluteTimes) {
  const auto source = open_scan_source(file("pcd/compressed_ring_timestamp_f64.pcd"));
  const auto sweep = source->next();
  ASSERT_EQ(sweep->points.size(), 80787U);
  EXPECT_EQ(source->info().point_times, "field timestamp (float64), s since an epoch");
  EXPECT_EQ(sweep->stamp_ns / 1'000'000'000, 1'635'236'489);
  const float last = *std::max_element(sweep->times_s.begin(), sweep->times_s.end());
  EXPECT_NEAR(last, 0.1F, 0.01F);
}

TEST_F(RealFiles, Ply) {
  const RawCloud cloud = read_ply(file("ply/small_gicp_source.ply"));
  ASSERT_EQ(cloud.points.size(), 69792U);
  // The same cloud is there as a PCD.
  const RawCloud twin = read_pcd(file("pcd/fast_gicp_251371071.pcd"));
  EXPECT_EQ(cloud.points, twin.points);
  EXPECT_EQ(cloud.intensities, twin.intensities);
  for (const char* name : {"ply/tiny_cloud-ascii.ply", "ply/tiny_cloud-binary.ply"}) {
    EXPECT_EQ(read_ply(file(name)).points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(1, 2, 3)}) << name;
  }
}

TEST_F(RealFiles, Bin) {
  const fs::path nuscenes = file("nuscenes/sample_5float.pcd.bin");
  expect_io_error([&] { read_bin(nuscenes); }, {"5 columns"});
  const RawCloud cloud = read_bin(nuscenes, "x,y,z,intensity,ring");
  EXPECT_EQ(cloud.points.size(), 70755U);
  expect_plausible(cloud);
  expect_io_error([&] { read_bin(file("nclt/1326652795280148.bin")); }, {"bin_fields"});
}

TEST_F(RealFiles, TimesThatBeginAnewInEveryPacket) {
  const fs::path cloud = file("db3/velodyne_vlp16/1673400472138016708.pcd");
  expect_io_error([&] { open_scan_source(cloud)->next(); }, {"time_stamp (uint32)", "1304065", "point_time_unit"});
  SourceOptions options;
  options.point_times = PointTimes::kNone;
  const auto sweep = open_scan_source(cloud, options)->next();
  EXPECT_EQ(sweep->points.size(), 14831U);
  EXPECT_EQ(sweep->stamp_ns, 1'673'400'472'138'016'708);
}

TEST_F(RealFiles, Malformed) {
  expect_io_error([&] { read_pcd(file("malformed/truncated_ascii.pcd")); }, {"line 7780", "POINTS 25301"});
  expect_io_error([&] { read_pcd(file("malformed/width0_height0_points26585.pcd")); },
                  {"WIDTH 0 × HEIGHT 0 and POINTS 26585"});
}

}  // namespace
}  // namespace rilo::test
