// The packets of a sensor, whatever they were recorded in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rilo::detail {

struct Datagram {
  std::int64_t received_ns = 0;
  std::uint16_t port = 0;    ///< destination; 0: unknown
  std::string_view payload;  ///< valid until the next call
  std::string_view sender;   ///< its address, 4 or 16 bytes, valid as long; empty: unknown
};

class PacketStream {
 public:
  virtual ~PacketStream() = default;

  /// The next packet in the order of the recording, or nothing at the end.
  /// @throws IoError when a message cannot be read; the following call continues after it.
  virtual std::optional<Datagram> next() = 0;

  /// The container, for people: "mcap (zstd)"; empty for a capture.
  virtual std::string format() const { return ""; }
  /// Of the messages; empty: unknown.
  virtual std::string frame_id() const { return ""; }
  /// Whether other packets than the LiDAR's are in it as a matter of course.
  virtual bool is_mixed() const = 0;
  /// Whether it ended where it did because the file lost bytes while it was read.
  virtual bool shortened() const { return false; }
  /// Sentences for the user.
  virtual std::vector<std::string> warnings() const = 0;

 protected:
  PacketStream() = default;
  PacketStream(const PacketStream&) = default;
  PacketStream& operator=(const PacketStream&) = default;
};

}  // namespace rilo::detail
