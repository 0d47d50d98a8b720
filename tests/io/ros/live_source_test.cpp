// Messages as they arrive: the sweeps of a recording of the same messages, drops, looking ahead, the end.
#include <future>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "rilo/io/live_queue.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

std::shared_ptr<LiveQueue> live_queue(std::size_t limit, std::size_t look_ahead) {
  LiveQueueOptions options;
  options.limit = limit;
  options.look_ahead = look_ahead;
  return std::make_shared<LiveQueue>(options);
}

std::vector<Recorded> ros1_messages(std::size_t count) {
  return recorded(numbered_sweeps(count), MessageEncoding::kRos1);
}

void push_all(LiveQueue& queue, const std::vector<Recorded>& messages) {
  for (const Recorded& message : messages) queue.push({message.received_ns, message.bytes});
}

TEST(LiveSource, SweepsAreThoseOfARecording) {
  const TempDir folder;
  // Stamps that jitter: the period, and with it times from the azimuth, depends on the messages looked at.
  auto sweeps = numbered_sweeps(20, 60);
  for (std::size_t i = 0; i < sweeps.size(); ++i)
    sweeps[i].stamp_ns += static_cast<std::int64_t>(i * i % 7) * 1'300'000;
  const auto messages = recorded(sweeps, MessageEncoding::kRos1);
  McapShape shape;
  shape.encoding = "ros1";
  const auto file = folder.write("drive.mcap", mcap_bytes({{"/points", kRos1Type}}, messages, shape));
  for (const PointTimes times : {PointTimes::kAuto, PointTimes::kAzimuth}) {
    SourceOptions options;
    options.point_times = times;
    options.elevation_correction_deg = 0.3;
    const auto recording = open_scan_source(file, options);
    const auto queue = live_queue(0, 12);
    push_all(*queue, messages);
    const auto live = open_live_source(queue, options);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      const auto expected = recording->next();
      const auto sweep = live->next();
      ASSERT_TRUE(expected && sweep);
      expect_same_sweep(*sweep, *expected);
      EXPECT_EQ(live->current_index(), i);
    }
    EXPECT_EQ(live->info().period_s, recording->info().period_s);
    EXPECT_EQ(live->info().point_times, recording->info().point_times);
    EXPECT_EQ(live->info().frame_id, "lidar");
    EXPECT_EQ(live->info().topic, "/points");
  }
}

TEST(LiveSource, TheFreshestMessagesAreKept) {
  const auto queue = live_queue(2, 0);
  push_all(*queue, ros1_messages(5));
  EXPECT_EQ(queue->counts().received, 5U);
  EXPECT_EQ(queue->counts().dropped, 3U);
  EXPECT_EQ(queue->counts().waiting, 2U);
  const auto source = open_live_source(queue);
  for (const std::size_t i : {3U, 4U}) EXPECT_EQ(source->next()->stamp_ns, numbered_sweeps(5)[i].stamp_ns);
  EXPECT_EQ(queue->counts().waiting, 0U);
}

TEST(LiveSource, WholeSweepsMayWaitWhereTheyComeInParts) {
  const auto queue = live_queue(2, 0);
  const auto messages = ros1_messages(40);
  push_all(*queue, {messages.begin(), messages.begin() + 2});
  SourceOptions options;
  options.parts = 5;
  const auto source = open_live_source(queue, options);
  push_all(*queue, {messages.begin() + 2, messages.end()});
  EXPECT_EQ(queue->counts().waiting, 10U);
  EXPECT_EQ(queue->counts().dropped, 30U);
}

TEST(LiveSource, WhatIsLookedAtIsNotDropped) {
  const auto queue = live_queue(1, 3);
  const auto messages = ros1_messages(30);
  push_all(*queue, messages);  // nobody reads yet: 1 and twice the looking ahead may wait
  EXPECT_EQ(queue->counts().dropped, 23U);
  const auto source = open_live_source(queue);
  EXPECT_EQ(queue->counts().waiting, 4U);
  for (std::size_t i = 23; i < 30; ++i) EXPECT_EQ(source->next()->stamp_ns, numbered_sweeps(30)[i].stamp_ns);
  push_all(*queue, messages);
  EXPECT_EQ(queue->counts().waiting, 1U);  // from now on
}

TEST(LiveSource, LookingAheadEndsWhenNothingComes) {
  LiveQueueOptions options;
  options.look_ahead_wait_s = 0.01;
  const auto queue = std::make_shared<LiveQueue>(options);
  push_all(*queue, ros1_messages(2));
  const auto source = open_live_source(queue);
  EXPECT_NEAR(source->info().period_s, 0.1, 1e-9);
  EXPECT_TRUE(source->next());
  EXPECT_TRUE(source->next());
}

TEST(LiveSource, AMessageThatCannotBeReadIsReportedInItsTurn) {
  for (const std::size_t look_ahead : {0U, 3U}) {
    const auto queue = live_queue(0, look_ahead);
    auto messages = ros1_messages(3);
    messages[1].bytes.resize(40);
    push_all(*queue, messages);
    const auto source = open_live_source(queue);
    EXPECT_TRUE(source->next());
    expect_io_error([&] { source->next(); }, {"message 2 of /points"});
    EXPECT_EQ(source->next()->stamp_ns, numbered_sweeps(3)[2].stamp_ns);
  }
}

TEST(LiveSource, ClosingEndsAReaderThatWaits) {
  const auto queue = live_queue(2, 0);
  const auto source = open_live_source(queue);
  auto waiting = std::async(std::launch::async, [&] { return source->next().has_value(); });
  queue->close();
  EXPECT_FALSE(waiting.get());
  push_all(*queue, ros1_messages(1));
  EXPECT_FALSE(source->next());
  EXPECT_EQ(queue->counts().received, 0U);
}

}  // namespace
}  // namespace rilo::test
