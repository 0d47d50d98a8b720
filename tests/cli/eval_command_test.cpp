// rilo eval.
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

TEST(EvalCommand, AgreesWithTheMetricsOfTheRun) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "out", "--quiet"});
  const json of_run = json_file(folder / "out" / "metrics.json")["evaluation"];
  const json of_eval = eval({shared_drive(), folder / "out" / "poses_lidar.txt"});
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

TEST(EvalCommand, MixedForms) {
  const TempDir folder;
  const std::string tum = folder.write("a.tum", straight_tum(20, 0));
  const std::string kitti = folder.write("b.txt", straight_kitti(20));
  EXPECT_NEAR(eval({tum, kitti})["ape_unaligned_m"]["max"].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(eval({kitti, tum})["ape_unaligned_m"]["max"].get<double>(), 0.0, 1e-9);
  rilo_fails(2, {"eval", tum, kitti, "--associate", "stamp"}, {"stamp"});
}

TEST(EvalCommand, LengthsThatDoNotFit) {
  const TempDir folder;
  const std::string shorter = folder.write("shorter.txt", straight_kitti(9));
  const std::string longer = folder.write("longer.txt", straight_kitti(10));
  rilo_fails(3, {"eval", shorter, longer}, {"shorter.txt (9 poses)", "longer.txt (10 poses)"});
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
}

}  // namespace
}  // namespace rilo::test
