// The poses of a run that is still going on, or was killed.
#include "results/partial_poses.hpp"

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "results/saved_run.hpp"

namespace rilo::test {
namespace {

using testing::ElementsAre;

SE3 pose_at(double x_m) { return SE3(Eigen::Translation3d(x_m, 0, 0)); }

TEST(PartialPoses, SayWhichSweepsTheyAreOf) {
  const TempDir folder;
  std::string text = partial_pose_line(pose_at(1), 0, 0) + partial_pose_line(pose_at(2), 1, 1);
  EXPECT_EQ(text.find('#'), std::string::npos);  // nothing to say
  text += partial_pose_line(pose_at(5), 4, 2) + partial_pose_line(pose_at(6), 5, 5);
  const auto file = folder.write(kPartialPoses, text + "# sweep 9\n1 0 0");
  const PosesSoFar so_far = read_partial_poses(file);
  EXPECT_THAT(so_far.sweeps, ElementsAre(0, 1, 4, 5));
  ASSERT_EQ(so_far.poses.size(), 4U);
  EXPECT_EQ(so_far.poses[2].translation().x(), 5.0);
}

TEST(PartialPoses, AKilledRunHasTheSweepsThatItHadReached) {
  const TempDir folder;
  folder.write(kPartialPoses, partial_pose_line(pose_at(0), 50, 0) + partial_pose_line(pose_at(1), 51, 51));
  const SavedRun saved = read_saved_run(folder.path());
  EXPECT_TRUE(saved.killed);
  EXPECT_THAT(saved.record.indices, ElementsAre(50, 51));
}

TEST(PartialPoses, OfAnOlderVersionAreThoseOfTheFirstSweeps) {
  const TempDir folder;
  folder.write(kPartialPoses, "1 0 0 0 0 1 0 0 0 0 1 0\n# a comment\n1 0 0 1 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(read_saved_run(folder.path()).record.indices, ElementsAre(0, 1));
}

}  // namespace
}  // namespace rilo::test
