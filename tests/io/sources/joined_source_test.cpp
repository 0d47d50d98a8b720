// Sweeps that come in parts.
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "io/sources/parts_of_sweep.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"

namespace rilo::test {
namespace {

using detail::PartsOfSweep;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::int64_t stamp_ns(double s) { return std::llround(s * 1e9); }

/// What four beams see between two azimuths, in turns; the times count from its stamp.
Sweep sector(double begin, double end, double period_s, double at_s) {
  Sweep sweep;
  sweep.stamp_ns = stamp_ns(at_s);
  constexpr int kColumns = 300;
  for (int i = 0; i < kColumns; ++i) {
    const double share = static_cast<double>(i) / kColumns;
    const double azimuth = 2.0 * std::numbers::pi * (begin + share * (end - begin));
    for (const double slope : {-0.2, -0.1, 0.0, 0.1}) {
      sweep.points.push_back(10.0F * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), slope).cast<float>());
      sweep.times_s.push_back(static_cast<float>(share * period_s));
      sweep.rings.push_back(static_cast<std::uint16_t>(i % 7));
      sweep.intensities.push_back(static_cast<float>(at_s));
    }
  }
  return sweep;
}

/// A sensor that turns ten times a second, whose driver sends `parts` of each turn.
std::vector<Sweep> turns_in_parts(std::size_t count, std::size_t parts) {
  const double share = 1.0 / static_cast<double>(parts);
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < count; ++i) {
    const double begin = share * static_cast<double>(i);
    sweeps.push_back(sector(begin, begin + share, 0.1 * share, 0.1 * begin));
  }
  return sweeps;
}

/// A few hundred directions of its own in each sweep, as a rosette.
std::vector<Sweep> rosette(std::size_t count, double period_s) {
  std::vector<Sweep> sweeps(count);
  double angle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sweeps[i].stamp_ns = stamp_ns(static_cast<double>(i) * period_s);
    for (int k = 0; k < 400; ++k) {
      angle += 0.618034;
      const double radius = 0.6 * std::cos(3.6180339 * angle);
      sweeps[i].points.push_back(
          Eigen::Vector3d(10.0, 10.0 * radius * std::cos(angle), 10.0 * radius * std::sin(angle)).cast<float>());
    }
  }
  return sweeps;
}

std::size_t parts_found(const std::vector<Sweep>& sweeps, double period_s) {
  PartsOfSweep found(period_s);
  for (const Sweep& sweep : sweeps) {
    if (found.parts()) break;
    found.add(sweep);
  }
  return found.parts().value_or(0);
}

std::unique_ptr<ScanSource> joined(std::vector<Sweep> sweeps, double period_s, std::size_t parts,
                                   std::size_t fails_at = SIZE_MAX) {
  return detail::with_joined_parts(std::make_unique<SweepsSource>(std::move(sweeps), period_s, fails_at), parts);
}

TEST(PartsOfSweep, SectorsMakeATurn) {
  for (const std::size_t parts : {2U, 3U, 4U, 8U}) {
    EXPECT_EQ(parts_found(turns_in_parts(20, parts), 0.1 / static_cast<double>(parts)), parts);
  }
}

TEST(PartsOfSweep, OneWhereTheNextSeesTheSameDirections) {
  EXPECT_EQ(parts_found(turns_in_parts(5, 1), 0.05), 1U);  // 20 Hz
  EXPECT_EQ(parts_found(turns_in_parts(5, 1), 0.02), 1U);
}

TEST(PartsOfSweep, OneAtUsualRates) {
  for (const double period_s : {0.075, 0.1, 0.2, 1.0, 0.0, -0.1, 1e-4, std::nan("")}) {
    EXPECT_EQ(PartsOfSweep(period_s).parts(), 1U) << period_s;
  }
}

TEST(PartsOfSweep, ARosetteIsSeenForATenthOfASecond) {
  EXPECT_EQ(parts_found(rosette(30, 0.02), 0.02), 5U);
  EXPECT_EQ(parts_found(rosette(30, 0.01), 0.01), 10U);
  EXPECT_EQ(parts_found(rosette(30, 0.05), 0.05), 2U);
}

TEST(PartsOfSweep, PointsWithoutADirection) {
  std::vector<Sweep> sweeps(30);
  EXPECT_EQ(parts_found(sweeps, 0.02), 5U);
  for (Sweep& sweep : sweeps) {
    sweep.points = {Eigen::Vector3f::Zero(), Eigen::Vector3f(0, 0, 5), Eigen::Vector3f::Constant(std::nanf("")),
                    Eigen::Vector3f(INFINITY, 0, 0)};
  }
  EXPECT_EQ(parts_found(sweeps, 0.02), 5U);
}

TEST(JoinedSource, ThePointsOfAWholeTurnWithTheirTimes) {
  const std::vector<Sweep> parts = turns_in_parts(9, 4);
  const auto source = joined(parts, 0.025, 0);
  EXPECT_EQ(source->size(), 3U);
  for (const std::size_t first : {0U, 4U}) {
    const auto sweep = source->next();
    ASSERT_TRUE(sweep);
    EXPECT_EQ(sweep->stamp_ns, parts[first].stamp_ns);
    EXPECT_EQ(source->current_index(), first);
    EXPECT_EQ(source->current_name(), "sweep " + std::to_string(first));
    std::size_t at = 0;
    for (std::size_t part = first; part < first + 4; ++part) {
      for (std::size_t i = 0; i < parts[part].points.size(); ++i, ++at) {
        ASSERT_EQ(sweep->points[at], parts[part].points[i]);
        ASSERT_EQ(sweep->rings[at], parts[part].rings[i]);
        ASSERT_EQ(sweep->intensities[at], parts[part].intensities[i]);
        const double time_s =
            1e-9 * static_cast<double>(parts[part].stamp_ns - sweep->stamp_ns) + parts[part].times_s[i];
        ASSERT_NEAR(sweep->times_s[at], time_s, 1e-6);
      }
    }
    ASSERT_THAT(sweep->points, SizeIs(at));
    ASSERT_THAT(sweep->times_s, SizeIs(at));
  }
  EXPECT_EQ(source->next()->points.size(), parts[8].points.size());  // what is left
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST(JoinedSource, SaysWhatItFound) {
  const SourceInfo found = joined(turns_in_parts(20, 4), 0.025, 0)->info();
  EXPECT_EQ(found.parts, 4U);
  EXPECT_DOUBLE_EQ(found.period_s, 0.1);
  EXPECT_TRUE(found.has_point_times);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("every 0.025 s and hold parts of sweeps: 4 are joined")));
  const SourceInfo given = joined(turns_in_parts(20, 4), 0.025, 2)->info();
  EXPECT_EQ(given.parts, 2U);
  EXPECT_THAT(given.warnings, IsEmpty());
}

TEST(JoinedSource, WholeSweepsStayAsTheyAre) {
  const std::vector<Sweep> sweeps = turns_in_parts(4, 1);
  for (const double period_s : {0.1, 0.05}) {
    const auto source = joined(sweeps, period_s, 0);
    EXPECT_EQ(source->info().parts, 1U);
    EXPECT_FALSE(source->info().has_point_times);  // nothing is added to what is known
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      const auto sweep = source->next();
      ASSERT_TRUE(sweep);
      expect_same_sweep(*sweep, sweeps[i]);
      EXPECT_EQ(source->current_index(), i);
    }
    EXPECT_FALSE(source->next());
  }
}

TEST(JoinedSource, PointsWithoutTimesAreTakenAtTheStampOfTheirPart) {
  std::vector<Sweep> parts = turns_in_parts(4, 2);
  for (Sweep& part : parts) {
    part.points.resize(1);
    part.times_s.clear();
    part.rings.clear();
    part.intensities.resize(1);
  }
  parts[1].intensities.clear();
  const auto source = joined(parts, 0.05, 2);
  const auto first = source->next();
  ASSERT_TRUE(first);
  EXPECT_THAT(first->times_s, ElementsAre(0.0F, FloatNear(0.05F, 1e-6F)));
  EXPECT_THAT(first->intensities, IsEmpty());  // a column of all points or none
  EXPECT_THAT(first->rings, IsEmpty());
  EXPECT_THAT(source->next()->intensities, SizeIs(2));
  EXPECT_THAT(source->info().point_times, HasSubstr("stamps of the parts"));
}

TEST(JoinedSource, NotAcrossAGapOrAClockThatWasSet) {
  std::vector<Sweep> parts = turns_in_parts(8, 4);
  for (std::size_t i = 2; i < 8; ++i) parts[i].stamp_ns += stamp_ns(1.0);
  for (std::size_t i = 6; i < 8; ++i) parts[i].stamp_ns -= stamp_ns(5.0);
  const auto source = joined(parts, 0.025, 4);
  std::vector<std::size_t> first;
  while (const auto sweep = source->next()) first.push_back(source->current_index());
  EXPECT_THAT(first, ElementsAre(0U, 2U, 6U));
}

TEST(JoinedSource, APartThatCannotBeReadIsReportedInItsTurn) {
  for (const std::size_t fails_at : {0U, 1U, 2U}) {  // the source of the test stays there
    const auto source = joined(turns_in_parts(8, 2), 0.05, 2, fails_at);
    for (std::size_t i = 0; i < (fails_at + 1) / 2; ++i) EXPECT_TRUE(source->next());
    EXPECT_THROW(source->next(), IoError);
  }
}

TEST(JoinedSource, SkipsWholeSweeps) {
  for (const std::size_t parts : {0U, 4U}) {
    const auto source = joined(turns_in_parts(20, 4), 0.025, parts);
    EXPECT_EQ(source->skip(2), 2U);
    ASSERT_TRUE(source->next());
    EXPECT_EQ(source->current_index(), 8U);
    EXPECT_EQ(source->skip(1), 1U);
    ASSERT_TRUE(source->next());
    EXPECT_EQ(source->current_index(), 16U);
    EXPECT_EQ(source->skip(3), 0U);
    EXPECT_FALSE(source->next());
  }
}

// The end has been seen when the last sweep is shorter than others, or all data were looked at.
TEST(JoinedSource, TheEndIsNoSweepToSkip) {
  const auto source = joined(turns_in_parts(6, 4), 0.025, 4);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(source->next());
  EXPECT_EQ(source->skip(3), 0U);
  EXPECT_FALSE(source->next());
  const auto few = joined(rosette(3, 0.02), 0.02, 0);
  EXPECT_EQ(few->skip(5), 3U);
  EXPECT_FALSE(few->next());
}

TEST(JoinedSource, FewerThanNeededToKnow) {
  const auto source = joined(rosette(3, 0.02), 0.02, 0);
  EXPECT_EQ(source->info().parts, 1U);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
}

}  // namespace
}  // namespace rilo::test
