// The packets in the messages of a recording.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/packets/packet_stream.hpp"
#include "io/ros/packet_messages.hpp"
#include "io/ros/recording.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

class RecordedPackets final : public PacketStream {
 public:
  /// `topic`: one of recording->topics() that holds packets.
  RecordedPackets(std::unique_ptr<Recording> recording, RecordedTopic topic);

  /// Back to the first packet.
  void restart();

  std::optional<Datagram> next() override;
  std::string format() const override { return recording_->format(); }
  std::string frame_id() const override { return frame_id_; }
  bool is_mixed() const override { return false; }
  std::vector<std::string> warnings() const override { return recording_->warnings(); }

 private:
  void unpack(const RecordedMessage& message);

  std::unique_ptr<Recording> recording_;
  RecordedTopic topic_;
  std::string frame_id_;
  std::vector<RecordedPacket> packets_;  // of the last message
  std::size_t next_packet_ = 0;
  std::size_t messages_ = 0;
};

/// Sweeps from a topic of packets. An Ouster's metadata may be a topic of the recording, too: see find_decoder().
/// @throws IoError as find_decoder().
std::unique_ptr<ScanSource> open_packet_topic(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                              const RecordedTopic& topic, const SourceOptions& options);

}  // namespace rilo::detail
