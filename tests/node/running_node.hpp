// A node without ROS: the messages of a drive go in, and what is published is kept.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/node/live_odometry.hpp"
#include "rilo/odometry/odometry.hpp"
#include "simulation/small_drive.hpp"

namespace rilo::test {

inline constexpr std::size_t kSweeps = 10;

inline const std::vector<Sweep>& drive() {
  static const std::vector<Sweep> kDrive = [] {
    std::vector<Sweep> sweeps = small_drive(kSweeps);
    for (std::size_t i = 0; i < kSweeps; ++i) {
      sweeps[i].stamp_ns = static_cast<std::int64_t>(i + 1) * 100'000'000;
      sweeps[i].rings.clear();  // the messages here have none
    }
    return sweeps;
  }();
  return kDrive;
}

// As ROS 2 hands a message over: the points stay where they are.
inline LiveQueue::Message message_of(const std::shared_ptr<const Sweep>& sweep) {
  LiveCloud cloud;
  cloud.message.stamp_ns = sweep->stamp_ns;
  cloud.message.frame_id = "velodyne";
  cloud.message.height = 1;
  cloud.message.width = static_cast<std::uint32_t>(sweep->points.size());
  constexpr std::uint8_t kFloat32 = 7;
  cloud.message.fields = {{"x", 0, kFloat32, 1}, {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1}};
  cloud.message.point_step = sizeof(Eigen::Vector3f);
  cloud.message.data = {reinterpret_cast<const char*>(sweep->points.data()),
                        sweep->points.size() * sizeof(Eigen::Vector3f)};
  cloud.owner = sweep;
  return {sweep->stamp_ns, cloud};
}

inline LiveQueue::Message message(std::size_t i) { return message_of(std::make_shared<Sweep>(drive()[i])); }

// Keeps everything that is published.
class Output final : public NodeOutput {
 public:
  void publish(const OdometryMessage& message) override { note(odometry, message); }
  void publish(const TransformMessage& message) override { note(transforms, message); }
  void publish(const PathMessage& message) override { note(paths, message); }
  void publish(CloudMessage&& message) override { note(maps, message); }
  bool path_wanted() const override { return wanted; }
  bool local_map_wanted() const override { return wanted; }
  std::optional<SE3> look_up(const std::string& base_frame, const std::string& lidar_frame) override {
    const std::lock_guard lock(mutex);
    asked.push_back(base_frame + " " + lidar_frame);
    changed.notify_all();
    return T_base_lidar;
  }
  void warn(const std::string& text) override { note(warnings, text); }
  void fail(const std::string& why) override { note(failures, why); }

  bool wait(const std::function<bool()>& condition) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(100), condition);
  }
  bool has_poses(std::size_t count) {
    const std::lock_guard lock(mutex);
    return odometry.size() >= count;
  }
  bool wait_poses(std::size_t count) {
    return wait([&] { return odometry.size() >= count; });
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::deque<OdometryMessage> odometry;
  std::deque<TransformMessage> transforms;
  std::deque<PathMessage> paths;
  std::deque<CloudMessage> maps;
  std::deque<std::string> warnings;
  std::deque<std::string> failures;
  std::deque<std::string> asked;
  std::optional<SE3> T_base_lidar;
  bool wanted = true;

 private:
  template <typename Message>
  void note(std::deque<Message>& into, const Message& message) {
    const std::lock_guard lock(mutex);
    into.push_back(message);
    changed.notify_all();
  }
};

inline NodeOptions at_once() {
  NodeOptions options;
  options.queue = 0;
  options.look_ahead = 0;
  options.source.point_times = PointTimes::kNone;  // the messages here have none
  options.path_period_s = 0;
  options.local_map_period_s = 0;
  return options;
}

inline std::vector<SE3> expected_poses(std::size_t count, const OdometryConfig& config = {}) {
  Odometry odometry(config);
  std::vector<SE3> poses;
  for (std::size_t i = 0; i < count; ++i) poses.push_back(odometry.register_sweep(drive()[i]).T_odom_lidar);
  return poses;
}

inline void expect_pose(const PoseMessage& pose, const SE3& expected) {
  EXPECT_EQ(pose.position, Eigen::Vector3d(expected.translation()));
  EXPECT_TRUE(pose.orientation.toRotationMatrix().isApprox(expected.linear(), 1e-12));
}

inline std::string value_of(const StatusMessage& status, const std::string& wanted) {
  for (const auto& [key, value] : status.values) {
    if (key == wanted) return value;
  }
  return "none";
}

// A node that runs with what at_once() says.
class RunningNode : public testing::Test {
 protected:
  RunningNode() { odometry.start(); }

  void push(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) odometry.push(message(i));
    ASSERT_TRUE(output.wait_poses(end));
  }

  Output output;
  LiveOdometry odometry{at_once(), "/points", output};
};

}  // namespace rilo::test
