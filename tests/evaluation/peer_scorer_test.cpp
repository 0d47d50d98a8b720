// Agreement with an independent scorer (tools/evaltraj.py in the folder RILO_SHARED or ../shared); skipped without it.
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include "evaluation/peer.hpp"
#include "evaluation/trajectories.hpp"
#include "rilo/evaluation/evaluation.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

constexpr double kRelative = 1e-6;

std::vector<SE3> read_poses(const fs::path& path) {
  std::ifstream file(path);
  std::vector<SE3> poses;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream numbers(line);
    SE3 T = SE3::Identity();
    for (int i = 0; i < 12; ++i) numbers >> T.matrix()(i / 4, i % 4);
    poses.push_back(T);
  }
  return poses;
}

class PeerScorer : public ::testing::Test {
 protected:
  void SetUp() override {
    scorer_ = shared_folder() / "tools" / "evaltraj.py";
    if (!fs::exists(scorer_)) {
      GTEST_SKIP() << "no " << scorer_;
    }
    if (!python_has("numpy")) {
      GTEST_SKIP() << "no /usr/bin/python3 with numpy";
    }
    folder_ = fs::temp_directory_path() / ("rilo_peer_scorer_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  /// Figures of the scorer by name, from its one line of JSON.
  std::map<std::string, double> score(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) const {
    const std::string command = "/usr/bin/python3 '" + scorer_.string() + "' '" +
                                write_poses(folder_ / "truth.txt", truth).string() + "' '" +
                                write_poses(folder_ / "estimate.txt", estimate).string() + "' --json";
    return peer_figures(command);
  }

  void expect_agreement(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) const {
    const std::map<std::string, double> peer = score(truth, estimate);
    ASSERT_EQ(peer.size(), 8U) << "unexpected output of the scorer";
    const Evaluation ours = evaluate(truth, estimate);
    const auto near = [&peer](const char* name, double value) {
      EXPECT_NEAR(value, peer.at(name), kRelative * peer.at(name)) << name;
    };
    near("path_m", ours.path_m);
    near("t_rel_pct", ours.kitti.t_rel_pct().value());
    near("r_rel_deg_100m", ours.kitti.r_rel_deg_100m().value());
    near("ape_rmse", ours.ape.translation_m.rmse);
    near("ape_mean", ours.ape.translation_m.mean);
    near("ape_std", ours.ape.translation_m.std);
    near("end_err_m", ours.end_error_m);
  }

  fs::path scorer_;
  fs::path folder_;
};

TEST_F(PeerScorer, AgreesOnRandomDrives) {
  std::mt19937 random(7);
  for (const double step : {0.3, 1.0, 2.5}) {  // 90 m: short path; 300 m; 750 m
    const std::vector<SE3> truth = random_drive(random, 301, step);
    expect_agreement(truth, with_drift(random, truth, 0.001, 0.01));
  }
}

TEST_F(PeerScorer, AgreesOnKittiGroundTruth) {
  std::mt19937 random(8);
  for (const char* name : {"00.txt", "01.txt", "03.txt", "04.txt"}) {
    const fs::path path = shared_folder() / "data" / "kitti_gt" / "poses" / name;
    if (!fs::exists(path)) {
      GTEST_SKIP() << "no " << path;
    }
    SCOPED_TRACE(name);
    const std::vector<SE3> truth = read_poses(path);
    ASSERT_GT(truth.size(), 200U);
    expect_agreement(truth, with_drift(random, truth, 0.0005, 0.01));
  }
}

}  // namespace
}  // namespace rilo::test
