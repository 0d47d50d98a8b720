// What is asked for with times of the data.
#include "results/run_request.hpp"

#include <gtest/gtest.h>

#include "rilo/session/session.hpp"

namespace rilo {
namespace {

TEST(RunRequest, TimesOfTheDataThatAreNeededAreNotReplaced) {
  RunRequest request;
  EXPECT_EQ(session_options(request, {}).point_times, PointTimes::kAuto);
  request.source.times_needed = true;
  EXPECT_EQ(session_options(request, {}).point_times, PointTimes::kNone);
}

TEST(RunRequest, ASweepWithPointsAndWithoutTimesIsRefusedWhereTheyAreNeeded) {
  Sweep sweep;
  SourceRequest request;
  const auto check = [&] { check_point_times(request, sweep, "sweep 7"); };
  request.times_needed = true;
  EXPECT_NO_THROW(check());  // no points, no times
  sweep.points = {{1, 2, 3}};
  EXPECT_THROW(check(), RunError);
  sweep.times_s = {0};
  EXPECT_NO_THROW(check());
  sweep.times_s.clear();
  request.times_needed = false;
  EXPECT_NO_THROW(check());
}

}  // namespace
}  // namespace rilo
