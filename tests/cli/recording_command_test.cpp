// rilo on a recording: the numbers of the same drive as files, and what was wrong with its stamps.
#include <cmath>

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

// Frames of the messages in an uncompressed MCAP: text with its length and final zero.
bool has_frame(const std::filesystem::path& mcap, const std::string& frame) {
  return slurp(mcap).find(Bytes(true).string(frame).text) != std::string::npos;
}

TEST(RecordingCommand, FramesOfTheDataOrAsGiven) {
  const TempDir folder;
  std::vector<Recorded> messages;
  for (const Sweep& sweep : numbered_sweeps(3)) {
    CloudMessage message = message_of(sweep);
    message.frame_id = "/velodyne";  // ROS 1 allowed the slash
    messages.push_back({"/points", sweep.stamp_ns, message_bytes(message, MessageEncoding::kCdr)});
  }
  const auto file = folder.write("drive.mcap", mcap_bytes({{"/points", kRos2Type}}, messages, {}));
  rilo_succeeds({"run", file, "--out", folder / "own", "--quiet", "--no-report"});
  EXPECT_TRUE(has_frame(folder / "own/trajectory.mcap", "velodyne"));
  EXPECT_TRUE(has_frame(folder / "own/trajectory.mcap", "odom"));
  EXPECT_FALSE(has_frame(folder / "own/trajectory.mcap", "lidar"));
  rilo_succeeds({"run", file, "--out", folder / "given", "--quiet", "--no-report", "--lidar-frame", "top_lidar",
                 "--odom-frame", "map"});
  EXPECT_TRUE(has_frame(folder / "given/trajectory.mcap", "top_lidar"));
  EXPECT_TRUE(has_frame(folder / "given/trajectory.mcap", "map"));
  EXPECT_FALSE(has_frame(folder / "given/trajectory.mcap", "odom"));
  EXPECT_FALSE(has_frame(folder / "given/trajectory.mcap", "velodyne"));
}

// Data without frames, whose first stamp is 0: the middle of azimuth times lies some hundred ns before it.
TEST(RecordingCommand, NoNegativeStamps) {
  const TempDir folder;
  for (int i = 0; i < 3; ++i) {
    std::string bytes;
    for (int k = 0; k < 2000; ++k) {
      const float angle = (static_cast<float>(k) + 0.5F) * 3.1415927F / 1000 - 3.1415627F;
      for (const float value : {10 * std::cos(angle), 10 * std::sin(angle), 0.1F * static_cast<float>(k % 7), 1.0F}) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
      }
    }
    folder.write("d/velodyne/" + std::to_string(i) + ".bin", bytes);
  }
  folder.write("d/times.txt", "0.0\n0.1\n0.2\n");
  rilo_succeeds({"run", folder / "d", "--out", folder / "out", "--quiet", "--no-report", "--point-times", "azimuth"});
  EXPECT_EQ(slurp(folder / "out/trajectory.tum").find("0.000000000 "), 0U) << slurp(folder / "out/trajectory.tum");
  EXPECT_TRUE(has_frame(folder / "out/trajectory.mcap", "lidar"));
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
             {"drive.mcap", "2 topics of point clouds", "/points (sensor_msgs/msg/PointCloud2, 13 messages)",
              "/rear (sensor_msgs/msg/PointCloud2, 0 messages)", "--topic"});
}

TEST(RecordingCommand, InfoListsTheTopicsToChooseFrom) {
  const TempDir folder;
  const auto file = recording(folder);
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", file, "--json"}).out);
  ASSERT_EQ(info["topics"].size(), 2U);
  EXPECT_EQ(info["topics"][0]["name"], "/points");
  EXPECT_EQ(info["topics"][0]["type"], "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(info["topics"][0]["messages"], 13);
  EXPECT_EQ(info["topics"][0]["frame_id"], "lidar");
  EXPECT_EQ(info["topics"][1]["name"], "/rear");
  EXPECT_NE(rilo_succeeds({"info", file}).out.find("--topic '/points' --out results"), std::string::npos);
}

TEST(RecordingCommand, ATopicOfDataWithoutTopicsIsANote) {
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", shared_drive(), "--topic", "/points", "--json"}).out);
  ASSERT_FALSE(info["warnings"].empty());
  EXPECT_NE(info["warnings"].dump().find("--topic '/points' is ignored"), std::string::npos);
}

TEST(RecordingCommand, FieldsThatMayHoldTimesAreNamed) {
  const TempDir folder;
  std::vector<Recorded> messages;
  for (const Sweep& sweep : numbered_sweeps(3)) {
    CloudMessage message = message_of(sweep);
    for (PointField& field : message.fields) {
      if (field.name == "time") field.name = "GpsTime";
    }
    messages.push_back({"/points", sweep.stamp_ns, message_bytes(message, MessageEncoding::kCdr)});
  }
  const auto file = folder.write("drive.mcap", mcap_bytes({{"/points", kRos2Type}}, messages, {}));
  expect_parts(rilo_succeeds({"info", file}).out,
               {"x y z intensity GpsTime ring; not used: GpsTime", "--time-field 'GpsTime'   (if"});
  expect_parts(rilo_succeeds({"run", file}).err, {"warning: field 'GpsTime' is not used", "--time-field GpsTime"});
  expect_parts(rilo_succeeds({"info", file, "--time-field", "GpsTime"}).out, {"point times   field GpsTime"});
}

}  // namespace
}  // namespace rilo::test
