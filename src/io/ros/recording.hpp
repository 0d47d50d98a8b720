// Messages of a recording, one after the other, whatever container they lie in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/io/point_cloud2.hpp"

namespace rilo {

class LiveQueue;

namespace detail {

struct RecordedTopic {
  std::string name;
  std::string type;      ///< "sensor_msgs/PointCloud2", "sensor_msgs/msg/PointCloud2", …
  std::string encoding;  ///< "ros1", "cdr", or what else the file says
  std::optional<std::uint64_t> messages;

  bool has_same_messages(const RecordedTopic& other) const {
    return name == other.name && type == other.type && encoding == other.encoding;
  }
};

/// Into a list of them, where those of the same messages are one: their counts are added, as far as they are known.
void add_topic(const RecordedTopic& topic, std::vector<RecordedTopic>& topics);

/// Of a topic whose encoding is "ros1" or "cdr".
MessageEncoding encoding_of(const RecordedTopic& topic);

struct RecordedMessage {
  std::int64_t received_ns = 0;  ///< when the recorder got it
  std::string_view bytes;        ///< valid until the next call
  std::filesystem::path file;
  const PointCloud2* cloud = nullptr;  ///< instead of bytes: the message itself, valid as long
};

/// Not thread-safe. Memory: what the largest message or chunk needs.
class Recording {
 public:
  virtual ~Recording() = default;

  /// For people: "mcap", "ROS 1 bag", "rosbag2 (sqlite3)".
  virtual std::string format() const = 0;

  virtual const std::vector<RecordedTopic>& topics() const = 0;

  /// Goes to the first message of that topic, one of topics(): those of its name and type.
  virtual void select(const RecordedTopic& topic) = 0;

  /// The next message of the selected topic, or nothing at the end.
  /// @throws IoError when it cannot be read; the following call continues after it.
  virtual std::optional<RecordedMessage> next() = 0;

  /// Messages of the topic that the last error of next() took: all of a damaged chunk.
  virtual std::size_t lost() const { return 1; }

  /// False from the first error on of which that is not known (lost() is 1 then), until the next selection.
  virtual bool places_known() const { return true; }

  /// Passes over `count` messages, or up to the end; returns how many there were. More where the last ones are lost
  /// together with some after them.
  virtual std::size_t skip(std::size_t count);

  /// Of the opening and so far: "cut off at byte 4711: the messages before are used".
  virtual std::vector<std::string> warnings() const { return {}; }

 protected:
  Recording() = default;
  Recording(const Recording&) = default;
  Recording& operator=(const Recording&) = default;
};

using OpenRecording = std::function<std::unique_ptr<Recording>(const std::filesystem::path&)>;

/// A single MCAP file: chunks or none, zstd, lz4 or no compression, indexed or cut off.
std::unique_ptr<Recording> open_mcap(const std::filesystem::path& file);
/// The SQLite3 file of a rosbag2.
std::unique_ptr<Recording> open_db3(const std::filesystem::path& file);
/// A rosbag2: its folder with metadata.yaml and its files, compressed or not; without metadata.yaml its .db3 or .mcap
/// files; or one of these.
std::unique_ptr<Recording> open_rosbag2(const std::filesystem::path& path);
/// By the names alone.
bool is_rosbag2(const std::filesystem::path& path);
/// A ROS 1 bag. @throws IoError where this build has no librosbag-storage.
std::unique_ptr<Recording> open_bag(const std::filesystem::path& file);

/// Messages that arrive now. The first selection gives those of the looking ahead and keeps them, the next one gives
/// them again and goes on.
std::unique_ptr<Recording> open_live(std::shared_ptr<LiveQueue> queue);

/// Several files that continue each other; one is open at a time.
std::unique_ptr<Recording> open_in_turn(std::vector<std::filesystem::path> files, const OpenRecording& open);

}  // namespace detail
}  // namespace rilo
