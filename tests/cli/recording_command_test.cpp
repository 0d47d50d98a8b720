// rilo on a recording: the numbers of the same drive as files, and what was wrong with its stamps.
#include "cli/drives.hpp"
#include "io/ros/ros_bytes.hpp"

namespace rilo::test {
namespace {

// The shared drive as MCAP; its third sweep comes twice.
std::filesystem::path recording(const TempDir& folder, const std::string& topic = "/points") {
  SourceOptions options;
  options.read_ahead = 0;
  const auto source = open_scan_source(shared_drive(), options);
  std::vector<Sweep> sweeps;
  while (auto sweep = source->next()) {
    sweeps.push_back(std::move(*sweep));
    if (sweeps.size() == 3) sweeps.push_back(sweeps.back());
  }
  auto messages = recorded(sweeps, MessageEncoding::kCdr);
  for (Recorded& message : messages) message.topic = topic;
  return folder.write("drive.mcap", mcap_bytes({{"/points", kRos2Type}, {"/rear", kRos2Type}}, messages, {"zstd", 2}));
}

TEST(RecordingCommand, RunGivesTheNumbersOfTheFiles) {
  const TempDir folder;
  const auto file = recording(folder);
  rilo_succeeds({"run", shared_drive(), "--out", folder / "files", "--quiet", "--no-report"});
  rilo_succeeds({"run", file, "--topic", "/points", "--out", folder / "recording", "--quiet"});
  EXPECT_EQ(slurp(folder / "recording/poses_lidar.txt"), slurp(folder / "files/poses_lidar.txt"));
  EXPECT_EQ(slurp(folder / "recording/trajectory.tum"), slurp(folder / "files/trajectory.tum"));
  const auto metrics = json_file(folder / "recording/metrics.json");
  EXPECT_EQ(metrics["topic"], "/points");
  EXPECT_EQ(metrics["frame_id"], "lidar");
  EXPECT_EQ(metrics["stamp_faults"]["duplicates"], 1);
  EXPECT_EQ(metrics["stamp_faults"]["gaps"], 0);
  EXPECT_EQ(metrics["pose_instant"], "mid");
  EXPECT_NE(slurp(folder / "recording/report.html").find("drive.mcap"), std::string::npos);
}

TEST(RecordingCommand, InfoSaysTopicAndFrame) {
  const TempDir folder;
  const auto file = recording(folder, "/rear");
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", file, "--topic", "/rear", "--json"}).out);
  EXPECT_EQ(info["kind"], "recording");
  EXPECT_EQ(info["format"], "mcap (zstd)");
  EXPECT_EQ(info["topic"], "/rear");
  EXPECT_EQ(info["frame_id"], "lidar");
  EXPECT_EQ(info["sweeps"], kDriveSweeps);
  EXPECT_EQ(info["stamp_faults"]["duplicates"], 1);
  EXPECT_EQ(info["point_times"]["source"], "field time (float32), s since the sweep's stamp");
  EXPECT_NE(rilo_succeeds({"info", file, "--topic", "/rear"}).out.find("/rear, frame lidar"), std::string::npos);
}

TEST(RecordingCommand, SeveralTopicsAreListed) {
  const TempDir folder;
  rilo_fails(3, {"run", recording(folder), "--out", folder / "out"},
             {"drive.mcap", "2 PointCloud2 topics", "/points (sensor_msgs/msg/PointCloud2, 13 messages)",
              "/rear (sensor_msgs/msg/PointCloud2, 0 messages)", "--topic"});
}

}  // namespace
}  // namespace rilo::test
