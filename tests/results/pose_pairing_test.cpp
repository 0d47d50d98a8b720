// Which true pose belongs to which estimated one, whatever their files are.
#include <gmock/gmock.h>

#include "evaluation/stamped_poses.hpp"
#include "io/io_test_util.hpp"
#include "results/pose_files.hpp"
#include "results/run_truth.hpp"
#include "results/sweep_times.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"

namespace rilo::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

PoseFile stamped_file(const std::vector<std::int64_t>& stamps_ms) {
  std::vector<std::int64_t> stamps_ns;
  for (const std::int64_t ms : stamps_ms) stamps_ns.push_back(ms * 1'000'000);
  PoseFile file;
  file.stamped = true;
  file.trajectory = stamped(stamps_ns);
  return file;
}

/// As those of a data folder, whose poses may be stamped so much later than its sweeps.
PoseFile of_data(const std::vector<std::int64_t>& stamps_ms, const std::vector<std::int64_t>& later_ms) {
  PoseFile file = stamped_file(stamps_ms);
  for (const std::int64_t ms : later_ms) file.offsets_ns.push_back(ms * 1'000'000);
  return file;
}

// Behind damage of unknown size the true poses by place are those of other sweeps.
TEST(PosePairing, NoTruthForSweepsWhosePlacesAreNotKnown) {
  const TempDir folder;
  RunRecord run;
  run.indices = {0, 1, 3, 4};
  run.results.resize(4);
  const auto pairs = [&] {
    std::vector<bool> paired;
    for (const auto& pose : poses_of_sweeps({folder / "poses.txt"}, run)) paired.push_back(pose.has_value());
    return paired;
  };
  folder.write("poses.txt", kitti_row(0, 0, 0) + kitti_row(1, 0, 0) + kitti_row(2, 0, 0) + kitti_row(3, 0, 0));
  EXPECT_THAT(pairs(), ElementsAre(true, true, true, false));
  run.source.places_known = 3;
  EXPECT_THAT(pairs(), ElementsAre(true, true, false, false));
}

TEST(PosePairing, SweepsThatWereJoinedLieAmongThePosesOfTheirParts) {
  const TempDir folder;
  folder.write("poses.txt", kitti_row(0, 0, 0) + kitti_row(1, 0, 0) + kitti_row(2, 0, 0) + kitti_row(3, 0, 0) +
                                kitti_row(4, 0, 0) + kitti_row(5, 0, 0));
  RunRecord run;
  run.indices = {0, 2, 4};
  run.results.resize(3);
  const auto places = [&](std::size_t parts, PoseInstant instant) {
    run.source.parts = parts;
    run.pose_instant = instant;
    std::vector<double> x;
    for (const auto& pose : poses_of_sweeps({folder / "poses.txt"}, run))
      x.push_back(pose ? pose->translation().x() : -1);
    return x;
  };
  EXPECT_THAT(places(2, PoseInstant::kMid), ElementsAre(0.5, 2.5, 4.5));
  EXPECT_THAT(places(2, PoseInstant::kStart), ElementsAre(0, 2, 4));
  EXPECT_THAT(places(2, PoseInstant::kEnd), ElementsAre(1, 3, 5));
  EXPECT_THAT(places(3, PoseInstant::kMid), ElementsAre(1, 3, 5));
  EXPECT_THAT(places(4, PoseInstant::kMid), ElementsAre(1.5, 3.5, -1));
}

TEST(PosePairing, ByTheOffsetThatFitsMostPoses) {
  const PoseFile estimate = stamped_file({0, 100, 200, 300, 400});
  for (const std::vector<std::int64_t>& later_ms : {std::vector<std::int64_t>{0}, {50, 0}, {200, 0}, {0, 200}}) {
    const PairedPoses paired = pair_poses(of_data({0, 100, 200, 300, 400}, later_ms), estimate, {});
    EXPECT_THAT(places(paired.poses.truth), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(paired.protocol, HasSubstr("paired by stamp, at most 0.02 s apart; 5 of 5 true and 5"));
  }
  // The true poses are those of sweeps that begin 50 ms before their middle.
  const PairedPoses later = pair_poses(of_data({-50, 50, 150, 250, 350}, {50}), estimate, {});
  EXPECT_THAT(later.poses.truth, SizeIs(5));
  EXPECT_THAT(later.protocol, HasSubstr("by stamp"));
}

TEST(PosePairing, ByIndexWhereStampsOfDataFitNotAll) {
  const PoseFile other_clock = stamped_file({0, 100, 200, 1300, 1400});
  const auto protocol = [&](const PoseFile& truth, Pairing pairing) {
    return pair_poses(truth, other_clock, {pairing, 0.02, 0}).protocol;
  };
  EXPECT_THAT(protocol(of_data({0, 100, 200, 300, 400}, {0}), Pairing::kAuto),
              HasSubstr("paired by index from true pose 0 on; 5 of 5 true and 5"));
  EXPECT_THAT(protocol(of_data({0, 100, 200, 300, 400}, {0}), Pairing::kStamp), HasSubstr("by stamp"));
  // Another number of poses, or those of a file, do not belong together by their place.
  EXPECT_THAT(protocol(of_data({0, 100, 200, 300, 400, 500}, {0}), Pairing::kAuto), HasSubstr("; 3 of 6 true and 5"));
  EXPECT_THAT(protocol(stamped_file({0, 100, 200, 300, 400}), Pairing::kAuto), HasSubstr("; 3 of 5 true and 5"));
}

TEST(PosePairing, ByIndexFromTheFirstOnWithAWarningWhereTheyAreNotAsMany) {
  PoseFile truth = stamped_file({0, 1, 2, 3, 4});
  truth.stamped = false;
  truth.warnings = {"of the truth"};
  const auto paired = [&](const PoseFile& estimate, std::size_t first) {
    return pair_poses(truth, estimate, {Pairing::kAuto, 0.02, first});
  };
  const PoseFile four = stamped_file({0, 1, 2, 3});
  EXPECT_THAT(paired(four, 0).warnings, ElementsAre("of the truth", HasSubstr("5 true and 4 estimated poses")));
  EXPECT_THAT(paired(stamped_file({0, 1, 2, 3, 4, 5}), 0).warnings, SizeIs(2));
  EXPECT_THAT(paired(four, 1).warnings, SizeIs(1));
  EXPECT_THAT(places(paired(four, 1).poses.truth), ElementsAre(1, 2, 3, 4));
  EXPECT_THROW(paired(four, 4), RunError);
  EXPECT_THROW(pair_poses(truth, four, {Pairing::kStamp, 0.02, 0}), RunError);
}

TEST(PosePairing, TheIndexIsAdvisedWhereThereIsAnOptionAndEnoughPoses) {
  const auto refusal = [](const PoseFile& estimate, bool advised) {
    PairingOptions options;
    options.index_advised = advised;
    try {
      pair_poses(stamped_file({0, 100, 200}), estimate, options);
    } catch (const RunError& error) {
      return std::string(error.what());
    }
    return std::string("paired");
  };
  const PoseFile other_clock = stamped_file({5000, 5100, 5200});
  EXPECT_THAT(refusal(other_clock, true), HasSubstr("same clock, or take --associate index"));
  EXPECT_THAT(refusal(other_clock, false), Not(HasSubstr("--associate")));
  EXPECT_THAT(refusal(stamped_file({0}), true), AllOf(HasSubstr("at least two poses"), Not(HasSubstr("--associate"))));
}

TEST(PosePairing, TheFirstLineThatIsNoCommentShowsTheForm) {
  const TempDir folder;
  const auto file = folder.write("t.txt", "\n# t x y z qx qy qz qw\n1.5 7 0 0 0 0 0 1\n");
  const PoseFile poses = read_poses(file);
  EXPECT_TRUE(poses.stamped);
  EXPECT_EQ(poses.trajectory.at(0).stamp_ns, 1'500'000'000);
}

TEST(SweepTimes, AsTheDataSayOrAsPosesMayBeStamped) {
  const TempDir folder;
  const std::string point = bytes_of<float>({1, 2, 3, 0});
  for (const char* name : {"0.bin", "1.bin", "2.bin"}) folder.write(std::string("bin/velodyne/") + name, point);
  EXPECT_THAT(sweep_times(folder / "bin", PoseInstant::kMid).stamps_ns, SizeIs(0));  // a rate is assumed
  folder.write("bin/times.txt", "7\n7.1\n7.2\n");
  const SweepTimes stamped = sweep_times(folder / "bin", PoseInstant::kMid);
  EXPECT_THAT(stamped.stamps_ns, ElementsAre(7'000'000'000, 7'100'000'000, 7'200'000'000));
  EXPECT_THAT(stamped.offsets_ns, ElementsAre(0, 0, 50'000'000));

  // Points that are timed from an epoch: the sweep begins 30 ms after the time in the file's name.
  const auto ply = [](const std::string& seconds) {
    return "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
           "property double timestamp\nend_header\n1 2 3 " +
           seconds + ".03\n1 2 3 " + seconds + ".11\n";
  };
  folder.write("ply/1600000000000000000.ply", ply("1600000000"));
  folder.write("ply/1600000001000000000.ply", ply("1600000001"));
  const auto offset_ns = [&](PoseInstant instant) { return sweep_times(folder / "ply", instant).offsets_ns.at(0); };
  EXPECT_NEAR(static_cast<double>(offset_ns(PoseInstant::kStart)), 30e6, 1e3);
  EXPECT_NEAR(static_cast<double>(offset_ns(PoseInstant::kMid)), 70e6, 1e3);
  EXPECT_NEAR(static_cast<double>(offset_ns(PoseInstant::kEnd)), 110e6, 1e3);
}

/// Sweeps 3 and 5 of the data, 100 ms apart.
RunRecord of_two_sweeps() {
  RunRecord run;
  for (const std::size_t index : {3U, 5U}) {
    SweepResult result;
    result.stamp_ns = static_cast<std::int64_t>(index) * 50'000'000;
    run.results.push_back(result);
    run.indices.push_back(index);
  }
  return run;
}

TEST(PosesOfSweeps, ByTheirPlaceInTheDataOrByStamp) {
  const TempDir folder;
  const RunRecord run = of_two_sweeps();
  std::vector<SE3> six;
  for (const StampedPose& pose : stamped_file({0, 1, 2, 3, 4, 5}).trajectory) six.push_back(pose.T_odom_lidar);
  write_kitti_poses(folder / "six.txt", six);
  const auto by_place = poses_of_sweeps({folder / "six.txt"}, run);
  ASSERT_EQ(by_place.size(), 2U);
  EXPECT_EQ(by_place[0]->translation().x(), 3);
  EXPECT_EQ(by_place[1]->translation().x(), 5);
  six.pop_back();
  write_kitti_poses(folder / "five.txt", six);
  EXPECT_FALSE(poses_of_sweeps({folder / "five.txt"}, run)[1]);

  RunRecord longer = of_two_sweeps();  // the first sweep has no true pose
  longer.results.insert(longer.results.begin(), SweepResult{});
  longer.results[0].stamp_ns = 60'000'000;
  longer.indices = {1, 3, 5};
  write_tum(folder / "t.tum", stamped_file({150, 250}).trajectory);
  const auto by_stamp = poses_of_sweeps({folder / "t.tum"}, longer);
  ASSERT_EQ(by_stamp.size(), 3U);
  EXPECT_FALSE(by_stamp[0]);
  EXPECT_EQ(by_stamp[1]->translation().x(), 0);
  EXPECT_EQ(by_stamp[2]->translation().x(), 1);
}

// The camera looks along the LiDAR's x: forward is its z.
TEST(PosesOfSweeps, InTheCameraFrame) {
  const TempDir folder;
  RunRecord run = of_two_sweeps();
  std::vector<SE3> forward(6, SE3::Identity());
  forward[5].translation().z() = 2;
  write_kitti_poses(folder / "cam.txt", forward);
  EXPECT_THROW(poses_of_sweeps({folder / "cam.txt", true}, run), RunError);
  SE3 T_cam_lidar = SE3::Identity();
  T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  run.source.T_cam_lidar = T_cam_lidar;
  const auto poses = poses_of_sweeps({folder / "cam.txt", true}, run);
  EXPECT_LT((poses[1]->translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
}

TEST(PosesOfSweeps, AWarningAboutTheTruthIsOneOfTheRun) {
  const TempDir folder;
  folder.write("poses_velo.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n");
  RunRecord run = of_two_sweeps();
  run.data = folder.path();
  run.indices = {0, 1};
  run.pose_instant = PoseInstant::kEnd;
  evaluate_run(run);
  EXPECT_EQ(run.truth_error, "");
  EXPECT_EQ(run.evaluation->poses, 2U);
  EXPECT_THAT(run.source.warnings, ElementsAre(HasSubstr("poses_velo.txt is at the stamps, not at the end")));
}

TEST(PosesOfSweeps, OnlySweepsWithBothAreCompared) {
  const SE3 at_0 = SE3::Identity();
  SE3 at_1 = SE3::Identity();
  at_1.translation().x() = 1;
  const TruthMatch match = match_truth({{at_0, at_0, std::nullopt, at_1}, "file", "mid", {}}, {at_0, {}, at_0, at_1});
  EXPECT_THAT(places(match.truth), ElementsAre(0, 1));
  EXPECT_THAT(places(match.estimate), ElementsAre(0, 1));
  EXPECT_THAT(match.matched, ElementsAre(0, 3));
  EXPECT_EQ(match.instant, "mid");
  EXPECT_THROW(match_truth({{at_0, std::nullopt}, "file", "mid", {}}, {at_0, at_1}), RunError);
}

}  // namespace
}  // namespace rilo::test
