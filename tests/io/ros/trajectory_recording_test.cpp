// The MCAP file of a run: what our own reader of recordings finds in it, and, where there is one, the reader of
// @mcap/core (environment variable RILO_NODE_MODULES, see mcap_core_test.cpp).
#include <array>
#include <cstdlib>
#include <cstring>

#include "io/io_test_util.hpp"
#include "io/ros/mcap_records.hpp"
#include "io/ros/recording.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

constexpr std::int64_t kFirstStamp = 1'700'000'000'123'456'789;

std::vector<SweepResult> some_results(std::size_t count) {
  std::vector<SweepResult> results(count);
  for (std::size_t i = 0; i < count; ++i) {
    SweepResult& result = results[i];
    const double k = static_cast<double>(i);
    result.stamp_ns = kFirstStamp + 100'000'000 * static_cast<std::int64_t>(i);
    result.T_odom_lidar.linear() = so3_exp(Eigen::Vector3d(0, 0, 1.5707963267948966));
    result.T_odom_lidar.translation() = Eigen::Vector3d(k, 2 * k, -k);
    result.twist << 0.1, 0.2, 0.3, 4, 5, 6;
    result.covariance.diagonal() << 1, 2, 3, 10, 20, 30;
  }
  return results;
}

struct Written {
  std::int64_t stamp_ns = 0;
  std::string bytes;
};

// The messages of a channel, out of the chunks.
std::vector<Written> messages_of(const std::filesystem::path& path, std::uint16_t channel) {
  using detail::mcap::Opcode;
  detail::mcap::RecordFile file(path);
  std::vector<Written> messages;
  std::uint64_t at = detail::mcap::kMagic.size();
  while (const auto record = file.record_at(at)) {
    at = record->end();
    if (record->opcode == Opcode::kFooter) break;
    if (record->opcode != Opcode::kChunk) continue;
    file.look_into(*record, [&](detail::ByteCursor cursor) {
      detail::mcap::take_chunk_header(cursor);
      cursor.take<std::uint64_t>("size of the records");
      while (!cursor.at_end()) {
        const auto opcode = static_cast<Opcode>(cursor.take<std::uint8_t>("opcode"));
        const auto length = cursor.take<std::uint64_t>("length");
        const std::string_view content = cursor.take_bytes(length, "record");
        if (opcode != Opcode::kMessage) continue;
        detail::ByteCursor inner(content, cursor.origin());
        const auto header = detail::mcap::take_message_header(inner);
        if (header.channel_id != channel) continue;
        messages.push_back({header.log_time_ns, std::string(content.substr(detail::mcap::MessageHeader::kBytes))});
      }
    });
  }
  return messages;
}

double number_at(std::string_view bytes, std::size_t offset) {
  double value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

TEST(TrajectoryRecordingTest, OdometryAndTransformsOfEverySweep) {
  const TempDir folder;
  const auto results = some_results(3);
  write_mcap(folder.path() / "run.mcap", results);
  const auto recording = detail::open_mcap(folder.path() / "run.mcap");
  EXPECT_TRUE(recording->warnings().empty());
  ASSERT_EQ(recording->topics().size(), 2U);
  EXPECT_EQ(recording->topics()[0].name, "/odometry");
  EXPECT_EQ(recording->topics()[0].type, "nav_msgs/msg/Odometry");
  EXPECT_EQ(recording->topics()[0].messages, 3U);
  EXPECT_EQ(recording->topics()[1].name, "/tf");
  EXPECT_EQ(recording->topics()[1].type, "tf2_msgs/msg/TFMessage");

  const auto odometry = messages_of(folder.path() / "run.mcap", 1);
  ASSERT_EQ(odometry.size(), 3U);
  EXPECT_EQ(odometry[1].stamp_ns, kFirstStamp + 100'000'000);
  // After the encapsulation: stamp 8 bytes, "odom" 4 + 5, padding 3, "lidar" 4 + 6, padding 2; then numbers.
  const std::string_view body = std::string_view(odometry[1].bytes).substr(4);
  EXPECT_EQ(body.substr(12, 5), std::string_view("odom\0", 5));
  EXPECT_EQ(body.substr(24, 6), std::string_view("lidar\0", 6));
  constexpr std::size_t kPose = 32;
  ASSERT_EQ(body.size(), kPose + 8 * (7 + 36 + 6 + 36));
  EXPECT_EQ(number_at(body, kPose), 1);
  EXPECT_EQ(number_at(body, kPose + 8), 2);
  EXPECT_EQ(number_at(body, kPose + 16), -1);
  EXPECT_NEAR(number_at(body, kPose + 40), std::sqrt(0.5), 1e-12);  // z and w of the quaternion
  EXPECT_NEAR(number_at(body, kPose + 48), std::sqrt(0.5), 1e-12);
  // Position first, about the axes of the odometry frame: the sensor's x is its y.
  const auto covariance = [&](std::size_t i) { return number_at(body, kPose + 56 + 8 * 7 * i); };
  EXPECT_NEAR(covariance(0), 20, 1e-9);
  EXPECT_NEAR(covariance(1), 10, 1e-9);
  EXPECT_NEAR(covariance(2), 30, 1e-9);
  EXPECT_NEAR(covariance(3), 2, 1e-9);
  EXPECT_NEAR(covariance(4), 1, 1e-9);
  EXPECT_NEAR(covariance(5), 3, 1e-9);
  EXPECT_EQ(number_at(body, kPose + 344), 4);         // linear velocity, sensor frame
  EXPECT_EQ(number_at(body, kPose + 344 + 24), 0.1);  // angular
  // Of the velocity over the step of 0.1 s, about the sensor's axes; unknown where there was no pose before.
  const auto of_velocity = [](std::string_view message, std::size_t i) {
    return number_at(message, 4 + kPose + 344 + 48 + 8 * 7 * i);
  };
  const std::array<double, 6> variances{1000, 2000, 3000, 100, 200, 300};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(of_velocity(odometry[1].bytes, i), variances[i], 1e-6) << i;
    EXPECT_EQ(of_velocity(odometry[0].bytes, i), 1e6) << i;
  }

  const auto tf = messages_of(folder.path() / "run.mcap", 2);
  ASSERT_EQ(tf.size(), 3U);
  // Count, stamp, "odom", padding, "lidar", padding to 8, seven numbers.
  EXPECT_EQ(tf[0].bytes.size(), 4U + 4 + 8 + 9 + 3 + 10 + 6 + 8 * 7);
}

TEST(TrajectoryRecordingTest, StampsThatRosDoesNotKnow) {
  const TempDir folder;
  auto results = some_results(3);
  results[0].stamp_ns = -594;
  results[1].stamp_ns = 0;
  results[2].stamp_ns = std::int64_t{1} << 62;
  write_mcap(folder.path() / "run.mcap", results);
  for (const std::uint16_t channel : {std::uint16_t{1}, std::uint16_t{2}}) {
    const auto messages = messages_of(folder.path() / "run.mcap", channel);
    ASSERT_EQ(messages.size(), 3U);
    const std::size_t at = channel == 1 ? 4 : 8;  // TFMessage: behind the number of transforms
    std::vector<std::int32_t> seconds;
    for (const Written& message : messages) {
      EXPECT_GE(message.stamp_ns, 0);
      std::array<std::int32_t, 2> stamp{};
      std::memcpy(stamp.data(), message.bytes.data() + at, sizeof(stamp));
      seconds.push_back(stamp[0]);
      EXPECT_EQ(stamp[1], message.stamp_ns == 0 ? 0 : 999'999'999);
    }
    EXPECT_EQ(seconds, (std::vector<std::int32_t>{0, 0, 0x7FFFFFFF}));
  }
}

TEST(TrajectoryRecordingTest, ManyChunksAndNone) {
  const TempDir folder;
  write_mcap(folder.path() / "long.mcap", some_results(3000));
  const auto tf = messages_of(folder.path() / "long.mcap", 2);
  EXPECT_EQ(tf.size(), 3000U);
  for (std::size_t i = 1; i < tf.size(); ++i) EXPECT_GT(tf[i].stamp_ns, tf[i - 1].stamp_ns);
  const auto recording = detail::open_mcap(folder.path() / "long.mcap");
  EXPECT_EQ(recording->topics()[0].messages, 3000U);
  EXPECT_TRUE(recording->warnings().empty());

  write_mcap(folder.path() / "empty.mcap", {});
  EXPECT_EQ(detail::open_mcap(folder.path() / "empty.mcap")->topics().size(), 2U);
  expect_io_error([&] { write_mcap(folder.path() / "missing" / "run.mcap", {}); }, {"missing"});
}

TEST(TrajectoryRecordingTest, ReadByMcapCore) {
  const char* modules = std::getenv("RILO_NODE_MODULES");
  if (modules == nullptr) GTEST_SKIP() << "RILO_NODE_MODULES is not set";
  const TempDir folder;
  write_mcap(folder.path() / "run.mcap", some_results(3000));
  const std::string command = "node '" RILO_SOURCE_DIR "/tests/io/ros/read_mcap.cjs' '" + std::string(modules) + "' '" +
                              (folder.path() / "run.mcap").string() + "' /odometry 3000 /tf 3000";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

}  // namespace
}  // namespace rilo::test
