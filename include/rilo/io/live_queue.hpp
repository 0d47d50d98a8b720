// PointCloud2 messages on their way from the thread that receives them to the one that reads them. C++17, as ROS 1's
// headers need it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "rilo/io/point_cloud2.hpp"

namespace rilo {

struct LiveQueueOptions {
  std::string topic = "/points";  ///< for messages
  std::size_t limit = 2;          ///< messages that may wait: beyond it the oldest goes; 0: all wait
  /// The first messages show the sweeps' period, as at the start of a recording (12 there): these are held back, and
  /// none of them is dropped. 0: none, the period is 1 / SourceOptions::assumed_rate_hz().
  std::size_t look_ahead = 12;
  double look_ahead_wait_s = 3;  ///< a longer wait for a message ends the look-ahead
};

struct LiveQueueCounts {
  std::size_t received = 0;
  std::size_t dropped = 0;  ///< because the reader was too slow
  std::size_t waiting = 0;
};

/// A message in the memory of its owner: nothing of it is copied.
struct LiveCloud {
  PointCloud2 message;
  std::shared_ptr<const void> owner;  ///< keeps what message.data looks into
};

/// Messages on their way from the thread that receives them to the one that reads the source.
class LiveQueue {
 public:
  struct Message {
    std::int64_t received_ns = 0;
    std::variant<std::string, LiveCloud> content;  ///< the bytes of a ROS 1 message, or one as ROS 2 hands it over
  };

  explicit LiveQueue(LiveQueueOptions options) : options_(std::move(options)) {}

  /// Never waits. While the messages of the look-ahead are being processed, more may wait: twice as many, less those
  /// taken.
  void push(Message message);

  /// So many messages make up a sweep: LiveQueueOptions::limit is one of sweeps from then on.
  void join(std::size_t parts);

  /// The source that reads ends, so that another one can be opened on what comes: it looks ahead again.
  void end_source();
  /// Whether that was asked for since the last call; from here on messages are handed out again.
  bool take_end_of_source();

  /// Wakes the reader: the source ends with what is waiting thrown away.
  void close();

  /// Waits for the oldest message. Nothing after close(), or when `longest_s` passes without one.
  std::optional<Message> pop(std::optional<double> longest_s = std::nullopt);

  LiveQueueCounts counts() const;
  const LiveQueueOptions& options() const { return options_; }

 private:
  LiveQueueOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Message> waiting_;
  std::size_t parts_ = 1;
  std::size_t received_ = 0;
  std::size_t taken_ = 0;
  std::size_t dropped_ = 0;
  bool closed_ = false;
  bool source_ends_ = false;
};

}  // namespace rilo
