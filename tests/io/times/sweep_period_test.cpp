// How long a sensor turns for a sweep, where some were left out.
#include "io/times/sweep_period.hpp"

#include "io/io_test_util.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"

namespace rilo::test {
namespace {

TEST(TurnTest, IsThePeriodUpTo250Milliseconds) {
  for (const double period_s : {0.05, 0.1, 0.1036, 0.2, 0.25}) {
    EXPECT_EQ(detail::turn_s(period_s), period_s);
    std::vector<std::string> warnings;
    detail::note_left_out(period_s, period_s, warnings);
    EXPECT_TRUE(warnings.empty());
  }
}

TEST(TurnTest, IsTheShareOfALongerPeriodNearestTo100Milliseconds) {
  EXPECT_DOUBLE_EQ(detail::turn_s(0.26), 0.26 / 3);
  EXPECT_DOUBLE_EQ(detail::turn_s(0.3107), 0.3107 / 3);
  EXPECT_DOUBLE_EQ(detail::turn_s(0.5), 0.1);
  EXPECT_DOUBLE_EQ(detail::turn_s(1.04), 0.104);
  std::vector<std::string> warnings;
  detail::note_left_out(0.3107, detail::turn_s(0.3107), warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("sweeps are 0.311 s apart"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("a turn is taken to last 0.104 s"), std::string::npos) << warnings[0];
}

TEST(TurnTest, OfSourcesThatTimeThePoints) {
  Sweep sweep;
  sweep.points.assign(100, Eigen::Vector3f(-1, 1, 0));
  const auto thinned = [&] { return std::make_unique<SweepsSource>(std::vector<Sweep>{sweep}, 0.6); };
  const auto by_azimuth = detail::with_azimuth_times(thinned());
  EXPECT_NEAR(by_azimuth->next()->times_s[0], -0.1 * 3 / 8, 1e-6);
  EXPECT_EQ(by_azimuth->info().point_times, "azimuth, clockwise, period 0.100000 s");
  EXPECT_EQ(by_azimuth->info().warnings.size(), 1U);
  const auto by_order = detail::with_order_times(thinned());
  EXPECT_EQ(by_order->info().point_times, "order of the points, period 0.100000 s");
  EXPECT_EQ(by_order->info().warnings.size(), 1U);
}

TEST(TurnTest, OfADriveOfWhichEveryThirdSweepWasKept) {
  const TempDir folder;
  write_sequence(folder, 3, "0\n0.3\n0.6\n");
  SourceOptions options;
  options.point_times = PointTimes::kAzimuth;
  const auto source = open_scan_source(folder.path(), options);
  EXPECT_DOUBLE_EQ(source->info().period_s, 0.3);
  EXPECT_EQ(source->info().point_times, "azimuth, clockwise, period 0.100000 s");
  source->next();
  EXPECT_NEAR(source->next()->times_s[0], -0.1F / 8, 1e-6F);  // 45 degrees to the left
  EXPECT_TRUE(has_warning(source->info(), "some were left out"));
}

}  // namespace
}  // namespace rilo::test
