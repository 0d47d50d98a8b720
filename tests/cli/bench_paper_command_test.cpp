// rilo bench kitti and rilo bench m2dgr, on roots made of a simulated drive.
#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

TEST(BenchPaperCommand, KittiRoot) {
  const TempDir root;
  fs::create_directories(root / "sequences");
  fs::copy(shared_drive(), root / "sequences" / "04", fs::copy_options::recursive);
  const Outcome bench = rilo_succeeds(
      {"bench", "kitti", root.path(), "--out", root / "out", "--count", "5", "--quiet", "--threads", "1"});
  for (const char* part :
       {"Table I:", "Table II:", "paper RMSE", "rilo, 0° RMSE", "rilo, 0.205° RMSE", "rilo, own estimate RMSE",
        "Avg of our 1", "15.30", "18.4", "first 5 sweeps of each sequence"}) {
    EXPECT_THAT(bench.out, HasSubstr(part));
  }
  const json results = json_file(root / "out" / "results.json");
  ASSERT_EQ(results["cells"].size(), 3U);
  EXPECT_EQ(results["cells"][1]["metrics"]["elevation_correction_deg"], 0.205);
  EXPECT_EQ(results["cells"][1]["metrics"]["elevation_estimated"], false);
  EXPECT_EQ(results["cells"][2]["metrics"]["elevation_correction_deg"], 0.0);
  EXPECT_EQ(results["cells"][2]["metrics"]["elevation_estimated"], true);
  EXPECT_NE(results["cells"][0]["figures"]["ape_rmse_m"], results["cells"][1]["figures"]["ape_rmse_m"]);
}

TEST(BenchPaperCommand, M2dgrRootWithABagThatIsNotUnpacked) {
  const TempDir root;
  const fs::path hall = root / "hall_01";
  fs::create_directories(hall);
  fs::copy(shared_drive() / "velodyne", hall, fs::copy_options::recursive);
  fs::copy(shared_drive() / "times.txt", hall / "times.txt");
  rilo_succeeds({"run", hall, "--out", root / "truth", "--quiet", "--count", "5"});
  fs::rename(root / "truth" / "trajectory.tum", root / "hall_01.txt");
  root.write("door_01.bag", "#ROSBAG V2.0\n");
  root.write("door_01.txt", slurp(root / "hall_01.txt"));
  const Outcome bench = rilo_fails(3, {"bench", "m2dgr", root.path(), "--out", root / "out", "--count", "5", "--quiet"},
                                   {"1 of 2 cells failed", "door_01", "bag"});
  EXPECT_THAT(bench.out, HasSubstr("Table III: APE on M2DGR"));
  const json results = json_file(root / "out" / "results.json");
  ASSERT_EQ(results["cells"].size(), 2U);
  EXPECT_LT(results["cells"][1]["figures"]["ape_rmse_m"].get<double>(), 1e-6);  // against its own poses
}

TEST(BenchPaperCommand, RootsWithoutSequences) {
  const TempDir root;
  rilo_fails(3, {"bench", "kitti", root.path()}, {"sequences/00/velodyne"});
  rilo_fails(3, {"bench", "m2dgr", root.path()}, {"NAME.txt"});
  rilo_fails(2, {"bench", "--data", "x", "kitti", root.path()}, {"--data"});
}

}  // namespace
}  // namespace rilo::test
