// The packets in the messages of a recording.
#include <optional>
#include <utility>

#include "io/packets/find_decoder.hpp"
#include "io/packets/packet_source.hpp"
#include "io/ros/driver_messages.hpp"
#include "io/ros/recording_source.hpp"
#include "io/ros/scan_topic.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

// "/os_node/" of "/os_node/lidar_packets".
std::string name_space(const std::string& topic) { return topic.substr(0, topic.rfind('/') + 1); }

// The driver publishes it beside the packets; with several sensors in a recording, each has its own.
std::optional<RecordedTopic> metadata_topic(const std::vector<RecordedTopic>& topics, const RecordedTopic& packets) {
  std::vector<RecordedTopic> found;
  for (const RecordedTopic& topic : topics) {
    if (!is_text(topic) || !topic.name.ends_with("metadata")) continue;
    if (name_space(topic.name) == name_space(packets.name)) return topic;
    found.push_back(topic);
  }
  if (found.size() == 1) return found[0];
  return std::nullopt;
}

RecordedMetadata recorded_metadata(Recording& recording, const RecordedTopic& packets) {
  const auto topic = metadata_topic(recording.topics(), packets);
  if (!topic) return {};
  recording.select(*topic);
  const auto message = recording.next();
  if (!message) return {};
  const std::string part = "topic " + topic->name;
  return {parse_text_message(message->bytes, encoding_of(*topic), {message->file, part}), part};
}

class RecordedPackets final : public PacketStream {
 public:
  // `topic`: one of recording->topics() that holds packets.
  RecordedPackets(std::unique_ptr<Recording> recording, RecordedTopic topic)
      : recording_(std::move(recording)), topic_(std::move(topic)) {
    restart();
  }

  // Back to the first packet.
  void restart() {
    recording_->select(topic_);
    packets_.clear();
    next_packet_ = 0;
    messages_ = 0;
  }

  std::optional<Datagram> next() override {
    while (next_packet_ == packets_.size()) {
      packets_.clear();
      next_packet_ = 0;
      const auto message = recording_->next();
      if (!message) return std::nullopt;
      ++messages_;
      unpack(*message);
    }
    const RecordedPacket& packet = packets_[next_packet_++];
    return Datagram{packet.received_ns, 0, packet.data, {}};
  }

  std::string format() const override { return recording_->format(); }
  std::string frame_id() const override { return frame_id_.value_or(""); }
  bool is_mixed() const override { return false; }
  std::vector<std::string> warnings() const override { return recording_->warnings(); }

 private:
  void check_frame(const std::string& frame_id, const BytesOrigin& origin) {
    if (!frame_id_) frame_id_ = frame_id;
    if (frame_id != *frame_id_) {
      reject_sensor(origin, "packets of frame " + in_quotes(frame_id), "frame " + in_quotes(*frame_id_));
    }
  }

  void unpack(const RecordedMessage& message) {
    const BytesOrigin origin{message.file, "message " + std::to_string(messages_) + " of " + topic_.name};
    if (scan_form(topic_) == ScanForm::kVelodynePackets) {
      VelodyneScan scan = parse_velodyne_scan(message.bytes, encoding_of(topic_), origin);
      check_frame(scan.frame_id, origin);
      packets_ = std::move(scan.packets);
      for (RecordedPacket& packet : packets_) {
        if (packet.received_ns == 0) packet.received_ns = message.received_ns;
      }
      return;
    }
    std::string_view packet = parse_ouster_packet(message.bytes, encoding_of(topic_), origin);
    // Ouster's first drivers gave the buffer a byte more than the packet, whose size is a multiple of four.
    if (packet.size() % 4 == 1) packet.remove_suffix(1);
    packets_.push_back({message.received_ns, packet});
  }

  std::unique_ptr<Recording> recording_;
  RecordedTopic topic_;
  std::optional<std::string> frame_id_;  // of the first message
  std::vector<RecordedPacket> packets_;  // of the last message
  std::size_t next_packet_ = 0;
  std::size_t messages_ = 0;
};

}  // namespace

std::unique_ptr<ScanSource> open_packet_topic(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                              const RecordedTopic& topic, const SourceOptions& options) {
  RecordedMetadata metadata;
  if (scan_form(topic) == ScanForm::kOusterPackets) metadata = recorded_metadata(*recording, topic);
  auto stream = std::make_unique<RecordedPackets>(std::move(recording), topic);
  auto decoder = find_decoder(*stream, path, options, metadata);
  stream->restart();
  return packet_source(path, topic.name, std::move(stream), std::move(decoder), options);
}

}  // namespace rilo::detail
