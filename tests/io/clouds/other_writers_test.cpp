// Clouds written by other programs: PCL 1.13 (pcl_convert_pcd_ascii_binary, pcl_pcd2ply) and meshio 5.0.0,
// all of the same four points, one of them NaN.

#include "io/io_test_util.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo {
namespace {

void expect_the_four_points(const RawCloud& cloud) {
  ASSERT_EQ(cloud.points.size(), 4U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5F, -2.25F, 0.125F));
  EXPECT_TRUE(cloud.points[1].isApprox(Eigen::Vector3f(1000.0625F, 2, -3), 1e-6F));  // PCL writes seven digits
  EXPECT_TRUE(cloud.points[2].array().isNaN().all());
  EXPECT_EQ(cloud.points[3], Eigen::Vector3f(-0.1F, 0.2F, 0.3F));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{10, 20, 0, 255}));
}

std::filesystem::path fixture(const std::string& name) {
  return std::filesystem::path(RILO_SOURCE_DIR) / "tests" / "io" / "clouds" / "fixtures" / name;
}

class OtherWriters : public testing::TestWithParam<const char*> {};

TEST_P(OtherWriters, AreRead) {
  const auto file = fixture(GetParam());
  expect_the_four_points(file.extension() == ".pcd" ? read_pcd(file) : read_ply(file));
}

INSTANTIATE_TEST_SUITE_P(Clouds, OtherWriters,
                         testing::Values("pcl_ascii.pcd", "pcl_binary.pcd", "pcl_compressed.pcd", "pcl_ascii.ply",
                                         "pcl_binary.ply", "meshio_text.ply", "meshio_binary.ply"));

}  // namespace
}  // namespace rilo
