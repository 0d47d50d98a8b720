// rilo eval.
#include <utility>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using nlohmann::json;

json eval(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "eval");
  arguments.emplace_back("--json");
  return json::parse(rilo_succeeds(arguments).out);
}

// `steps` poses, one every metre along x.
std::string straight_kitti(int steps, double scale = 1.0) {
  std::string text;
  for (int i = 0; i < steps; ++i) text += kitti_row(scale * i, 0, 0);
  return text;
}

std::string straight_tum(int steps, double offset_s, double scale = 1.0) {
  std::string text = "# t x y z qx qy qz qw\n";
  for (int i = 0; i < steps; ++i) {
    text += std::to_string(100.0 + 0.1 * i + offset_s) + " " + std::to_string(scale * i) + " 0 0 0 0 0 1\n";
  }
  return text;
}

void expect_same_figures(const json& of_eval, const json& of_run) {
  EXPECT_EQ(of_eval["poses"], of_run["poses"]);
  EXPECT_EQ(of_eval["t_rel_protocol"], of_run["t_rel_protocol"]);
  for (const char* key : {"t_rel_pct", "r_rel_deg_per_100m", "path_m", "end_error_m"}) {
    // Pose files are read as proper rotations: the ninth digit of a row moves the angle of a short segment.
    EXPECT_NEAR(of_eval[key].get<double>(), of_run[key].get<double>(), 1e-5 * (1 + of_run[key].get<double>())) << key;
  }
  for (const char* key : {"ape_m", "ape_unaligned_m", "rpe_frame_m", "rpe_metre_m_per_m"}) {
    for (const char* figure : {"rmse", "mean", "std", "median", "max"}) {
      EXPECT_NEAR(of_eval[key][figure].get<double>(), of_run[key][figure].get<double>(), 1e-6) << key << figure;
    }
  }
}

// Of a run with these options, whose poses are in `out`.
json figures_of_run(const std::filesystem::path& data, const std::filesystem::path& out,
                    const std::vector<std::string>& more) {
  std::vector<std::string> command = {"run", data, "--out", out, "--no-report", "--quiet"};
  command.insert(command.end(), more.begin(), more.end());
  rilo_succeeds(command);
  return json_file(out / "metrics.json")["evaluation"];
}

TEST(EvalCommand, AgreesWithTheMetricsOfTheRun) {
  const TempDir folder;
  const json of_run = figures_of_run(shared_drive(), folder / "out", {});
  expect_same_figures(eval({shared_drive(), folder / "out" / "poses_lidar.txt"}), of_run);
  expect_same_figures(eval({shared_drive(), folder / "out" / "trajectory.tum"}), of_run);
}

TEST(EvalCommand, StampsTellWhichSweepsOfTheDataWereRun) {
  const TempDir folder;
  const std::vector<std::vector<std::string>> runs = {
      {"--start", "3"},
      {"--start", "3", "--point-times", "none"},      // poses are at the stamps
      {"--start", "2", "--point-times", "azimuth"}};  // half a sweep later
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SCOPED_TRACE(i);
    const auto out = folder / std::to_string(i);
    const json of_run = figures_of_run(shared_drive(), out, runs[i]);
    expect_same_figures(eval({shared_drive(), out / "trajectory.tum"}), of_run);
    expect_same_figures(eval({shared_drive(), out / "trajectory.tum", "--associate", "stamp"}), of_run);
    expect_same_figures(eval({shared_drive(), out / "poses_lidar.txt", runs[i][0], runs[i][1]}), of_run);
  }
}

TEST(EvalCommand, ASweepThatWasSkippedMovesNoOther) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  append(sweep_file(drive, 5), 3);
  const json of_run = figures_of_run(drive, folder / "out", {"--skip-bad-sweeps"});
  ASSERT_EQ(of_run["poses"], kDriveSweeps - 1);
  expect_same_figures(eval({drive, folder / "out" / "trajectory.tum"}), of_run);
  const Outcome by_index = rilo_succeeds({"eval", drive, folder / "out" / "poses_lidar.txt"});
  expect_parts(by_index.err, {"poses_lidar.txt", "12 true and 11 estimated poses", "lacks a sweep"});
}

TEST(EvalCommand, StampsOfAnotherClockLeaveTheIndex) {
  const TempDir folder;
  const json of_run = figures_of_run(shared_drive(), folder / "out", {});
  std::string text;
  for (const std::string& line : lines_of(slurp(folder / "out" / "trajectory.tum"))) {
    if (!line.starts_with("#")) text += "1" + line + "\n";
  }
  const std::string other = folder.write("other.tum", text);
  expect_same_figures(eval({shared_drive(), other}), of_run);
  rilo_fails(3, {"eval", shared_drive(), other, "--associate", "stamp"}, {"other.tum", "clock", "--associate index"});
}

TEST(EvalCommand, KittiByHand) {
  const TempDir folder;
  const std::string truth = folder.write("truth.txt", straight_kitti(201));
  const std::string longer = folder.write("longer.txt", straight_kitti(201, 1.01));
  const json same = eval({truth, truth});
  EXPECT_EQ(same["poses"], 201);
  EXPECT_NEAR(same["path_m"].get<double>(), 200.0, 1e-9);
  EXPECT_NEAR(same["ape_m"]["max"].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(same["t_rel_pct"].get<double>(), 0.0, 1e-9);
  const json scaled = eval({truth, longer});
  // Segments end at the first pose strictly beyond 100 m: 101 of them, 1.01 m too far.
  EXPECT_NEAR(scaled["t_rel_pct"].get<double>(), 1.0, 0.02);
  EXPECT_NEAR(scaled["end_error_m"].get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(scaled["ape_unaligned_m"]["max"].get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(scaled["rpe_frame_m"]["mean"].get<double>(), 0.01, 1e-6);
}

TEST(EvalCommand, TumIsPairedByStamp) {
  const TempDir folder;
  const std::string truth = folder.write("truth.tum", straight_tum(100, 0));
  const std::string near = folder.write("near.tum", straight_tum(50, 0.004));
  EXPECT_EQ(eval({truth, near})["poses"], 50);
  const std::string later = folder.write("later.tum", straight_tum(50, 0.05));
  rilo_fails(3, {"eval", truth, later}, {"truth.tum", "later.tum"});
  EXPECT_EQ(eval({truth, later, "--max-gap-s", "0.06"})["poses"], 50);
}

TEST(EvalCommand, OptionsThatMakeNoDifferenceAreNamed) {
  const TempDir folder;
  const std::string kitti = folder.write("a.txt", straight_kitti(20));
  const std::string tum = folder.write("a.tum", straight_tum(20, 0));
  const auto ignored = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "eval");
    return lines_with(rilo_succeeds(arguments).err, "rilo: warning: --");
  };
  const auto of_tum = ignored({tum, tum, "--start", "1", "--max-gap-s", "0.1"});
  ASSERT_EQ(of_tum.size(), 1U);
  EXPECT_EQ(of_tum[0], "rilo: warning: --start is ignored: the poses are paired by stamp");
  EXPECT_EQ(ignored({kitti, kitti, "--start", "0", "--max-gap-s", "0.1", "--instant", "end"}).size(), 2U);
  EXPECT_TRUE(ignored({tum, tum, kitti, kitti, "--start", "0", "--max-gap-s", "0.1"}).empty());
  EXPECT_TRUE(ignored({shared_drive(), shared_drive() / "poses_end.txt", "--instant", "end"}).empty());
}

TEST(EvalCommand, MixedForms) {
  const TempDir folder;
  const std::string tum = folder.write("a.tum", straight_tum(20, 0));
  const std::string kitti = folder.write("b.txt", straight_kitti(20));
  EXPECT_NEAR(eval({tum, kitti})["ape_unaligned_m"]["max"].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(eval({kitti, tum})["ape_unaligned_m"]["max"].get<double>(), 0.0, 1e-9);
  rilo_fails(2, {"eval", tum, kitti, "--associate", "stamp"}, {"stamp"});
}

TEST(EvalCommand, OfDifferentLengthsTheFirstAreCompared) {
  const TempDir folder;
  const std::string shorter = folder.write("shorter.txt", straight_kitti(9));
  const std::string longer = folder.write("longer.txt", straight_kitti(10));
  for (const auto& [truth, estimate] : {std::pair(shorter, longer), std::pair(longer, shorter)}) {
    const json figures = eval({truth, estimate});
    EXPECT_EQ(figures["poses"], 9);
    EXPECT_EQ(figures["warnings"].size(), 1U);
    expect_parts(rilo_succeeds({"eval", truth, estimate}).err, {"rilo: warning:", "the first 9"});
  }
  EXPECT_EQ(rilo_succeeds({"eval", longer, shorter, "--start", "1"}).err, "");
  const std::string one = folder.write("one.txt", straight_kitti(1));
  rilo_fails(3, {"eval", one, longer}, {"one.txt (1 pose)", "longer.txt (10 poses)"});
}

TEST(EvalCommand, TruthOfTheDataMayBeShorterAsForARun) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  const auto lines = lines_of(slurp(drive / "poses_mid.txt"));
  std::string text;
  for (std::size_t i = 0; i + 2 < lines.size(); ++i) text += lines[i] + "\n";
  replace(drive / "poses_mid.txt", text);
  const json of_run = figures_of_run(drive, folder / "out", {});
  ASSERT_EQ(of_run["poses"], kDriveSweeps - 2);
  expect_same_figures(eval({drive, folder / "out" / "poses_lidar.txt"}), of_run);
  expect_same_figures(eval({drive, folder / "out" / "trajectory.tum"}), of_run);
  expect_parts(rilo_succeeds({"eval", drive, folder / "out" / "trajectory.tum"}).err, {"10 poses for 12 sweeps"});
}

TEST(EvalCommand, FilesThatAreNoPoses) {
  const TempDir folder;
  const std::string good = folder.write("good.txt", straight_kitti(5));
  rilo_fails(3, {"eval", good, folder / "missing.txt"}, {"missing.txt"});
  rilo_fails(3, {"eval", good, folder.write("empty.txt", "")}, {"empty.txt"});
  rilo_fails(3, {"eval", good, folder.write("seven.txt", "1 2 3 4 5 6 7\n")}, {"seven.txt", "7"});
  rilo_fails(3, {"eval", good, folder.write("cut.txt", straight_kitti(4) + "1 0 0\n")}, {"cut.txt", "line 5"});
  rilo_fails(3, {"eval", good, folder.write("scaled.txt", "2 0 0 0 0 2 0 0 0 0 2 0\n")}, {"scaled.txt", "line 1"});
  rilo_fails(3, {"eval", folder.path(), good}, {"no ground truth"});
  rilo_fails(3, {"eval", good, sweep_file(shared_drive(), 0)}, {"000000.bin"});
}

TEST(EvalCommand, TextForPeople) {
  const TempDir folder;
  const std::string truth = folder.write("truth.txt", straight_kitti(201));
  expect_parts(rilo_succeeds({"eval", truth, truth}).out, {"201 poses", "200.0 m", "t_rel", "APE", "RPE"});
  // Percent of a path of centimetres say nothing.
  const std::string at_rest = folder.write("rest.txt", straight_kitti(20, 0.001));
  const std::string text = rilo_succeeds({"eval", at_rest, truth}).out;
  EXPECT_NE(text.find("KITTI relative error               none: the path is too short"), std::string::npos) << text;
  EXPECT_EQ(text.find("t_rel"), std::string::npos) << text;
  // Nor do they count in the averages.
  const std::string longer = folder.write("longer.txt", straight_kitti(201, 1.02));
  const std::string both = rilo_succeeds({"eval", truth, longer, at_rest, truth}).out;
  EXPECT_NE(both.find("1 sequence: t_rel 2.0000 %"), std::string::npos) << both;
  EXPECT_NE(both.find("t_rel 2.0000 %   r_rel 0.0000 deg/100m   mean of the sequences"), std::string::npos) << both;
}

TEST(EvalCommand, AFolderInThePlaceOfPosesNamesThoseInIt) {
  const TempDir folder;
  const std::string truth = folder.write("truth.txt", straight_kitti(5));
  const std::string poses = folder.write("results/poses_lidar.txt", straight_kitti(5));
  rilo_fails(3, {"eval", truth, folder / "results"}, {"a folder; expected a pose file. Give " + poses});
  rilo_fails(3, {"eval", truth, folder.path()}, {"a folder; expected a pose file. Give a pose file, of the results"});
}

}  // namespace
}  // namespace rilo::test
