#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "io/io_test_util.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"

namespace rilo::test {
namespace {

double elevation(const Eigen::Vector3f& p) {
  return std::atan2(static_cast<double>(p.z()), std::hypot(static_cast<double>(p.x()), static_cast<double>(p.y())));
}
double azimuth(const Eigen::Vector3f& p) { return std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())); }

TEST(ElevationCorrectionTest, AddsTheAngleAndKeepsRangeAndAzimuth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-50, 50);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(uniform(random), uniform(random), uniform(random) / 10);
  auto corrected = points;
  detail::correct_elevation(corrected, 0.205);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(elevation(corrected[i]) - elevation(points[i]), 0.205 * std::numbers::pi / 180, 1e-6);
    EXPECT_NEAR(azimuth(corrected[i]), azimuth(points[i]), 1e-6);
    EXPECT_NEAR(corrected[i].norm(), points[i].norm(), 1e-4F);
  }
}

// The rotation about p × z, written out with Eigen.
TEST(ElevationCorrectionTest, IsTheRotationAboutPCrossZ) {
  const Eigen::Vector3d p(12, -7, 1.5);
  const Eigen::Vector3d axis = p.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d expected = Eigen::AngleAxisd(0.205 * std::numbers::pi / 180, axis) * p;
  std::vector<Eigen::Vector3f> points{p.cast<float>()};
  detail::correct_elevation(points, 0.205);
  EXPECT_LT((points[0].cast<double>() - expected).norm(), 1e-5);
}

TEST(ElevationCorrectionTest, PointsWithoutAzimuthStay) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Eigen::Vector3f> points{{0, 0, 5}, {0, 0, 0}, {kNan, 1, 1}, {1, 0, 0}};
  detail::correct_elevation(points, 90);
  EXPECT_EQ(points[0], Eigen::Vector3f(0, 0, 5));
  EXPECT_EQ(points[1], Eigen::Vector3f(0, 0, 0));
  EXPECT_TRUE(std::isnan(points[2].x()));
  EXPECT_NEAR(points[3].z(), 1, 1e-6F);
}

TEST(ElevationCorrectionTest, CorrectionsAddUpAndHaveALimit) {
  const auto corrected = [](double first_deg, double second_deg) {
    return detail::with_elevation_correction(
        detail::with_elevation_correction(std::make_unique<SweepsSource>(std::vector<Sweep>{}), first_deg), second_deg);
  };
  EXPECT_DOUBLE_EQ(corrected(0.25, 0.5)->info().elevation_correction_deg, 0.75);
  EXPECT_NO_THROW(corrected(10, -10));
  EXPECT_THROW(corrected(0, 10.01), std::invalid_argument);
}

TEST(ElevationCorrectionTest, SourceAppliesAndReportsIt) {
  const TempDir folder;
  folder.write("0.bin", bytes_of<float>({10, 0, 0, 0}));
  EXPECT_EQ(open_scan_source(folder.path())->info().elevation_correction_deg, 0);
  SourceOptions options;
  options.elevation_correction_deg = 1;
  const auto source = open_scan_source(folder.path(), options);
  EXPECT_EQ(source->info().elevation_correction_deg, 1);
  const auto sweep = source->next();
  EXPECT_NEAR(sweep->points[0].z(), 10 * std::sin(std::numbers::pi / 180), 1e-5);
  EXPECT_EQ(source->info().elevation_correction_deg, 1);
}

}  // namespace
}  // namespace rilo::test
