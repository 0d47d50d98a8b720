// rilo report.
#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

/// Folder of a run over the shared drive, made once a process; for reading only.
const fs::path& shared_run() {
  static const TempDir kFolder;
  static const fs::path kRun = [] {
    fs::path out = kFolder / "full";
    rilo_succeeds({"run", shared_drive(), "--out", out, "--map", out / "map.ply", "--quiet"});
    return out;
  }();
  return kRun;
}

fs::path copy_of_run(const TempDir& folder, const std::string& name) {
  fs::path copy = folder / name;
  fs::copy(shared_run(), copy, fs::copy_options::recursive);
  return copy;
}

void change_metrics(const fs::path& run, const std::string& key, const nlohmann::json& value) {
  nlohmann::json metrics = json_file(run / "metrics.json");
  metrics[key] = value;
  replace(run / "metrics.json", metrics.dump());
}

/// Data of the first comparison on the page.
nlohmann::json comparison_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\">";
  const std::size_t from = html.find(open, html.find("class=\"comparison\"")) + open.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(ReportCommand, ComparesRunsAndPosesOfOthers) {
  const TempDir folder;
  rilo_succeeds(
      {"run", shared_drive(), "--out", folder / "plain", "--quiet", "--no-report", "--set", "icp.adaptive=false"});
  const fs::path page = folder / "page.html";
  const Outcome outcome = rilo_succeeds({"report", shared_run(), "Plain <1>=" + (folder / "plain").string(),
                                         "Peer=" + (shared_run() / "trajectory.tum").string(), "-o", page});
  EXPECT_EQ(outcome.out, page.string() + ": 3 runs, 0 experiments\n");
  EXPECT_EQ(outcome.err, "");
  const std::string html = slurp(page);
  EXPECT_THAT(html, HasSubstr("3 runs compared"));
  EXPECT_THAT(html, HasSubstr("</i>full</th>"));
  EXPECT_THAT(html, HasSubstr("</i>Plain &lt;1&gt;</th>"));
  EXPECT_THAT(html, HasSubstr("</i>Peer</th>"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,"));
  // A peer of the same poses is as good as the run itself.
  const nlohmann::json data = comparison_of(html);
  for (const auto& figure : data["figures"]) {
    const auto& values = figure["values"];
    if (figure["unit"] == "m") {
      EXPECT_NEAR(values[0].get<double>(), values[2].get<double>(), 1e-5);
    } else if (figure["unit"] == "ms") {
      EXPECT_TRUE(values[2].is_null());
    }
  }
}

TEST(ReportCommand, PosesOfOthersHaveTheNumbersOfTheirSweeps) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "late", "--quiet", "--no-report", "--start", "5"});
  const fs::path page = folder / "page.html";
  rilo_succeeds({"report", folder / "late", "Peer=" + (folder / "late" / "trajectory.tum").string(), "-o", page});
  const std::string html = slurp(page);
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (auto at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count(R"("numbers":[5,6,)"), 2U);
}

TEST(ReportCommand, ASingleRunIsThePageOfRun) {
  const TempDir folder;
  rilo_succeeds({"report", shared_run(), "-o", folder / "one.html"});
  const std::string html = slurp(folder / "one.html");
  EXPECT_THAT(html, Not(HasSubstr("class=\"comparison\"")));
  EXPECT_THAT(html, HasSubstr("data-chart=\"top\""));
  EXPECT_THAT(html, HasSubstr("Accuracy"));
}

TEST(ReportCommand, PartialResultsSaySo) {
  const TempDir folder;
  const fs::path interrupted = copy_of_run(folder, "interrupted");
  change_metrics(interrupted, "interrupted", true);
  const fs::path killed = folder / "killed";
  fs::create_directory(killed);
  replace(killed / "poses_lidar.partial.txt", kitti_row(0, 0, 0) + kitti_row(1, 0, 0) + "1 0 0 2 0 1");
  const Outcome outcome = rilo_succeeds({"report", shared_run(), interrupted, killed, "-o", folder / "page.html"});
  EXPECT_THAT(outcome.err, HasSubstr("interrupted: The run was interrupted"));
  EXPECT_THAT(outcome.err, HasSubstr("killed: this run was killed or is still running"));
  EXPECT_THAT(outcome.err, HasSubstr("the runs are over different sweeps"));
  const std::string html = slurp(folder / "page.html");
  EXPECT_THAT(html, HasSubstr("<b>interrupted:</b> The run was interrupted"));
  EXPECT_THAT(html, HasSubstr("with its first 2 poses"));
}

TEST(ReportCommand, FiguresOutliveTheTruth) {
  const TempDir folder;
  const fs::path moved = copy_of_run(folder, "moved");
  change_metrics(moved, "data", (folder / "gone").string());
  const fs::path page = folder / "page.html";
  EXPECT_THAT(rilo_succeeds({"report", moved, "-o", page}).err, HasSubstr("are not where they were"));
  EXPECT_THAT(slurp(page), Not(HasSubstr("against truth")));
  EXPECT_THAT(slurp(page), HasSubstr("End error"));
  EXPECT_EQ(rilo_succeeds({"report", moved, "--gt", shared_drive() / "poses_mid.txt", "-o", page}).err, "");
  EXPECT_THAT(slurp(page), HasSubstr("Trajectory against truth"));
  EXPECT_EQ(rilo_succeeds({"report", moved, "--gt", shared_drive(), "-o", page}).err, "");
  EXPECT_THAT(slurp(page), HasSubstr("Trajectory against truth"));
}

TEST(ReportCommand, OtherSequencesAreGrouped) {
  const TempDir folder;
  const fs::path other = copy_of_run(folder, "other");
  change_metrics(other, "data", (folder / "second").string());
  const fs::path page = folder / "page.html";
  rilo_succeeds({"report", "a=" + shared_run().string(), "a=" + other.string(), "-o", page});
  const std::string html = slurp(page);
  EXPECT_THAT(html, HasSubstr("<h2>All sequences</h2>"));
  EXPECT_THAT(html, HasSubstr("<h2>second</h2>"));
  // Poses do not say which of the two they are of.
  const std::string poses = (shared_run() / "poses_lidar.txt").string();
  rilo_fails(2, {"report", shared_run(), other, "Peer=" + poses, "-o", page}, {"SEQUENCE/Peer", "second"});
  rilo_succeeds({"report", shared_run(), other, "second/Peer=" + poses, "-o", page});
  rilo_fails(2, {"report", shared_run(), other, "--gt", poses, "-o", page}, {"--gt", "SEQUENCE=FILE", "second"});
}

TEST(ReportCommand, PosesAlone) {
  const TempDir folder;
  std::string truth;
  std::string longer;
  for (int i = 0; i <= 200; ++i) {
    truth += kitti_row(i, 0, 0);
    longer += kitti_row(1.02 * i, 0, 0);
  }
  const std::string gt = folder.write("truth.txt", truth);
  const std::string exact = folder.write("exact.txt", truth);
  const std::string peer = folder.write("peer.txt", longer);
  rilo_succeeds({"report", exact, "Two percent=" + peer, "--gt", gt, "-o", folder / "page.html"});
  const std::string html = slurp(folder / "page.html");
  EXPECT_THAT(html, HasSubstr("</i>exact</th>"));
  EXPECT_THAT(html, HasSubstr("<td>2.0000</td>"));  // t_rel
  EXPECT_THAT(html, HasSubstr("<td>4.00</td>"));    // 200 m end 4 m too far
}

// Without a run beside them it is the data of the truth that say where the camera is.
TEST(ReportCommand, PosesOfTheCameraAlone) {
  const TempDir folder;
  std::string lidar;
  std::string camera;
  for (int i = 0; i <= 200; ++i) {
    lidar += kitti_row(i, 0, 0);
    camera += kitti_row(0, 0, i);
  }
  folder.write("drive/poses_mid.txt", lidar);
  folder.write("drive/calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  const std::string peer = folder.write("camera.txt", camera);
  const fs::path page = folder / "page.html";
  rilo_succeeds({"report", peer, "--pose-frame", "camera", "--gt", folder / "drive", "-o", page});
  EXPECT_THAT(slurp(page), HasSubstr("0.000<span class=\"unit\">%</span>"));  // t_rel
  rilo_fails(3, {"report", peer, "--pose-frame", "camera", "-o", page}, {"camera.txt", "calib.txt", "--gt"});
  rilo_fails(3, {"report", peer, "--pose-frame", "camera", "--gt", folder / "drive" / "poses_mid.txt", "-o", page},
             {"camera.txt", "calib.txt", "--gt"});
}

TEST(ReportCommand, ExperimentsWithSensitivity) {
  const TempDir folder;
  const auto cell = [](const std::string& name, const nlohmann::json& settings, double ape) {
    return nlohmann::json{{"sequence", "s"},
                          {"configuration", name},
                          {"kind", "run"},
                          {"settings", settings},
                          {"figures", {{"ape_rmse_m", ape}, {"ms_mean", nullptr}}}};
  };
  nlohmann::json results{{"rilo_bench", 1}, {"command", "rilo bench x"}, {"rilo_version", "0"}, {"cells_planned", 5},
                         {"cells_run", 4},  {"interrupted", true}};
  results["cells"] = {cell("defaults", nlohmann::json::array(), 1.0), cell("low", {"coarse.sigma=0.5"}, 2.0),
                      cell("high", {"coarse.sigma=1.5"}, 3.0), cell("off", {"coarse.enabled=false"}, 4.0)};
  folder.write("results.json", results.dump());
  rilo_succeeds({"report", "Mine=" + folder.path().string(), "-o", folder / "page.html"});
  const std::string html = slurp(folder / "page.html");
  EXPECT_THAT(html, HasSubstr("<h2>Mine</h2>"));
  EXPECT_THAT(html, HasSubstr("4 of 5 cells are finished"));
  EXPECT_THAT(
      html,
      HasSubstr(
          R"("sensitivities":[{"base":"defaults","key":"coarse.sigma","points":[[0.5,"low"],[1.0,"defaults"],[1.5,"high"]]}])"));
  rilo_fails(3, {"report", folder.write("other.json", "{}")}, {"other.json", "rilo bench"});
}

TEST(ReportCommand, RefusesWhatIsNoResult) {
  const TempDir folder;
  const std::string page = folder / "page.html";
  rilo_fails(3, {"report", folder / "none", "-o", page}, {"none", "rilo run", "Check the path"});
  rilo_fails(3, {"report", shared_drive(), "-o", page}, {"a folder with", "meta.json", "give them to rilo run"});
  rilo_fails(2, {"report", "name=", "-o", page}, {"name"});
  const std::string named = "A=" + shared_run().string();
  rilo_fails(2, {"report", named, named, "-o", page}, {"two results are named A", "NAME="});
  rilo_fails(3, {"report", shared_run(), "--gt", folder / "none", "-o", page}, {"--gt"});
  rilo_fails(4, {"report", shared_run(), "-o", folder / "no" / "page.html"}, {"page.html"});
  EXPECT_FALSE(fs::exists(page));
}

TEST(ReportCommand, ReplacesReportsAndNothingElse) {
  const TempDir folder;
  const std::string page = folder.write("page.html", "");  // nothing is lost with it
  for (int i = 0; i < 2; ++i) rilo_succeeds({"report", shared_run(), "-o", page});
  for (const char* name : {"poses.txt", "mine.html"}) {
    const std::string mine = folder.write(name, kitti_row(0, 0, 0) + kitti_row(1, 0, 0));
    rilo_fails(4, {"report", shared_run(), "-o", mine}, {name, "no report", "choose another -o"});
    EXPECT_EQ(slurp(mine), kitti_row(0, 0, 0) + kitti_row(1, 0, 0));
  }
}

TEST(ReportCommand, RefusesDamagedResults) {
  const TempDir folder;
  const fs::path run = copy_of_run(folder, "run");
  const std::string page = folder / "page.html";
  const std::string sweeps = slurp(run / "sweeps.csv");
  replace(run / "sweeps.csv", sweeps.substr(0, sweeps.size() - 40));
  rilo_fails(3, {"report", run, "-o", page}, {"sweeps.csv", "line 13"});
  replace(run / "sweeps.csv", sweeps.substr(0, sweeps.find('\n', sweeps.find('\n') + 1) + 1));
  rilo_fails(3, {"report", run, "-o", page}, {"poses_lidar.txt", "12 poses", "sweeps.csv"});
  replace(run / "sweeps.csv", "sweep,stamp_ns\n0,1\n");
  rilo_fails(3, {"report", run, "-o", page}, {"no column status"});
  fs::remove(run / "sweeps.csv");
  rilo_fails(3, {"report", run, "-o", page}, {"sweeps.csv"});
  replace(run / "metrics.json", R"({"threads": "many"})");
  rilo_fails(3, {"report", run, "-o", page}, {"metrics.json", "threads", "string", "number"});
  replace(run / "metrics.json", "{");
  rilo_fails(3, {"report", run, "-o", page}, {"metrics.json", "not JSON"});
  EXPECT_FALSE(fs::exists(page));
}

}  // namespace
}  // namespace rilo::test
