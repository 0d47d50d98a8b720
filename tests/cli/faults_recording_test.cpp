// Recordings that change while they are read: docs/faults.md.
#include <csignal>

#include <gmock/gmock.h>

#include "cli/drives.hpp"
#include "io/packets/packet_bytes.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kRecorded = 90;
constexpr std::size_t kCutAt = 80;

struct CutRecording {
  fs::path file;
  std::uintmax_t cut = 0;  // a byte of the sweep kCutAt
};

// The shared drive forth and back, half of its points.
std::vector<Recorded> long_recording(MessageEncoding encoding) {
  SourceOptions options;
  options.read_ahead = 0;
  std::vector<Sweep> drive = sweeps_of(*open_scan_source(shared_drive(), options));
  for (Sweep& sweep : drive) {
    sweep.points.resize(sweep.points.size() / 2);
    sweep.intensities.resize(sweep.points.size());
    sweep.times_s.resize(sweep.points.size());
  }
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < kRecorded; ++i) {
    constexpr std::size_t kPeriod = 2 * (kDriveSweeps - 1);
    sweeps.push_back(drive[std::min(i % kPeriod, kPeriod - i % kPeriod)]);
    sweeps.back().stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
  }
  return recorded(sweeps, encoding);
}

CutRecording cut_in(const fs::path& file, const std::string& message) {
  constexpr std::size_t kUnbroken = 100;  // bytes that a database keeps together
  const std::size_t place = slurp(file).find(message.substr(0, kUnbroken));
  EXPECT_NE(place, std::string::npos);
  return {file, place + kUnbroken};
}

CutRecording long_mcap(const TempDir& folder) {
  const auto messages = long_recording(MessageEncoding::kCdr);
  const auto file = folder.write("long.mcap", mcap_bytes({{"/points", kRos2Type}}, messages, {"", 1}));
  return cut_in(file, messages[kCutAt].bytes);
}

CutRecording long_db3(const TempDir& folder) {
  const auto messages = long_recording(MessageEncoding::kCdr);
  write_db3(folder / "long.db3", {{"/points", kRos2Type}}, messages);
  return cut_in(folder / "long.db3", messages[kCutAt].bytes);
}

#ifdef RILO_HAS_ROSBAG
CutRecording long_bag(const TempDir& folder) {
  const auto messages = long_recording(MessageEncoding::kRos1);
  write_bag(folder / "long.bag", {{"/points", kRos1Type}}, messages);
  return cut_in(folder / "long.bag", messages[kCutAt].bytes);
}
#endif

CutRecording long_pcap(const TempDir& folder) {
  constexpr std::uint32_t kPackets = 30;  // a turn
  Capture capture;
  CutRecording recording;
  for (std::uint32_t i = 0; i <= kRecorded * kPackets; ++i) {  // the last shows that a turn has ended
    if (i == kCutAt * kPackets) recording.cut = capture.text().size() + 100;
    const int azimuth = (18000 + static_cast<int>(i % kPackets) * 1200) % 36000;
    capture.udp(i * 3'333'000LL, 2368, velodyne_packet(azimuth, 100, i * 3333, 0x28));
  }
  recording.file = folder.write("long.pcap", capture.text());
  return recording;
}

// Runs, stops after the first sweep, changes the recording, goes on.
Outcome run_meanwhile(const fs::path& file, const fs::path& out, const std::function<void()>& change,
                      const std::vector<std::string>& options = {"--one-pass"}) {
  std::vector<std::string> arguments = {"run", file, "--out", out, "--threads", "1", "--quiet"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  CommandProcess run(arguments);
  EXPECT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
  run.send(SIGSTOP);
  EXPECT_LT(complete_lines(out / "poses_lidar.partial.txt"), kCutAt - 10);  // less what is read ahead
  change();
  run.send(SIGCONT);
  return run.wait();
}

using MakeRecording = CutRecording (*)(const TempDir&);

void expect_shortened(MakeRecording make, const std::string& said) {
  const TempDir folder;
  const auto out = folder / "out";
  const CutRecording recording = make(folder);
  const Outcome outcome = run_meanwhile(recording.file, out, [&] { fs::resize_file(recording.file, recording.cut); });
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(recording.file.string()));
  EXPECT_THAT(outcome.err, HasSubstr(said));
  const std::size_t kept = json_file(out / "metrics.json")["frames"];
  EXPECT_GE(kept, kCutAt - 1);
  EXPECT_LE(kept, kCutAt);
  EXPECT_THAT(outcome.err, HasSubstr("kept: " + std::to_string(kept) + " sweeps before it"));
  EXPECT_EQ(read_kitti_poses(out / "poses_lidar.txt").size(), kept);
}

void expect_old_one_read_to_its_end(MakeRecording make) {
  const TempDir folder;
  const fs::path file = make(folder).file;
  const auto other = folder.write("other", "not a recording");
  const Outcome outcome = run_meanwhile(file, folder / "out", [&] { fs::rename(other, file); });
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(slurp(file), "not a recording");
  EXPECT_EQ(json_file(folder / "out" / "metrics.json")["frames"], kRecorded);
}

TEST(FaultsOfRecordings, AnMcapFileBecomesShorter) { expect_shortened(long_mcap, "the file has become shorter"); }
TEST(FaultsOfRecordings, ADatabaseBecomesShorter) { expect_shortened(long_db3, "malformed"); }
TEST(FaultsOfRecordings, ACaptureBecomesShorter) { expect_shortened(long_pcap, "the file has become shorter"); }

// Synthetic turns tell nothing of the sensor: the run has one pass.
TEST(FaultsOfRecordings, ACaptureThatBecomesShorterMayBeLeftAtThat) {
  const TempDir folder;
  const CutRecording recording = long_pcap(folder);
  const Outcome outcome = run_meanwhile(recording.file, folder / "out",
                                        [&] { fs::resize_file(recording.file, recording.cut); }, {"--skip-bad-sweeps"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto metrics = json_file(folder / "out" / "metrics.json");
  EXPECT_THAT(metrics["warnings"].dump(), HasSubstr("the file has become shorter"));
  const std::size_t kept = metrics["frames"];
  EXPECT_GE(kept, kCutAt - 1);
  EXPECT_LE(kept, kCutAt);
}

TEST(FaultsOfRecordings, AnMcapFileIsReplaced) { expect_old_one_read_to_its_end(long_mcap); }
TEST(FaultsOfRecordings, ADatabaseIsReplaced) { expect_old_one_read_to_its_end(long_db3); }
TEST(FaultsOfRecordings, ACaptureIsReplaced) { expect_old_one_read_to_its_end(long_pcap); }

// Any estimate of the elevation counts as certain: the run has a second pass, for which there is no recording.
TEST(FaultsOfRecordings, OneThatIsReplacedBeforeTheSecondPassKeepsTheFirst) {
  const TempDir folder;
  const auto out = folder / "out";
  const fs::path file = long_mcap(folder).file;
  const auto other = folder.write("other", "not a recording");
  const Outcome outcome =
      run_meanwhile(file, out, [&] { fs::rename(other, file); }, {"--set", "elevation.significance=0"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the start of an MCAP file"));
  const std::size_t kept = json_file(out / "metrics.json")["frames"];
  EXPECT_EQ(kept, kRecorded);
  EXPECT_THAT(outcome.err, HasSubstr("kept: " + std::to_string(kept) + " sweeps before it"));
  EXPECT_EQ(read_kitti_poses(out / "poses_lidar.txt").size(), kept);
}

#ifdef RILO_HAS_ROSBAG
TEST(FaultsOfRecordings, ABagBecomesShorter) { expect_shortened(long_bag, "Error reading from file"); }
TEST(FaultsOfRecordings, ABagIsReplaced) { expect_old_one_read_to_its_end(long_bag); }
#endif

}  // namespace
}  // namespace rilo::test
