// A single MCAP file, read from front to back, a chunk at a time.
#include <algorithm>
#include <memory>
#include <set>

#include "io/ros/mcap_chunk.hpp"
#include "io/ros/mcap_contents.hpp"
#include "io/ros/mcap_records.hpp"
#include "io/ros/recording.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace mcap {
namespace {

// The records of the file, and the messages inside its chunks.
class Reader final : public Recording {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {
    try {
      contents_ = read_summary(file_);
    } catch (const IoError&) {
      // A damaged summary is as good as none.
    }
    if (!contents_.channels_told()) scan();
    topics_ = contents_.topics();
  }

  std::string format() const override {
    return chunk_.compression().empty() ? "mcap" : "mcap (" + chunk_.compression() + ")";
  }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override { return file_.warnings(); }

  void select(const RecordedTopic& topic) override {
    topic_ = topic;
    place_ = kMagic.size();
    chunk_.close();
    passed_ = 0;
    places_known_ = true;
    without_topic_.clear();
    for (const ChunkIndex& chunk : contents_.chunks) {
      const auto wanted = [&](std::uint16_t id) { return is_wanted(id); };
      if (!chunk.channels.empty() && std::none_of(chunk.channels.begin(), chunk.channels.end(), wanted)) {
        without_topic_.insert(chunk.offset);
      }
    }
  }

  std::optional<RecordedMessage> next() override {
    while (true) {
      lost_ = 1;
      try {
        auto message = walk([&](const MessageHeader& header) { return is_wanted(header.channel_id); });
        if (message) ++passed_;
        return message;
      } catch (const IoError&) {
        note_lost();
        if (lost_ > 0) throw;  // else the chunk has nothing of the topic
      }
    }
  }

  std::size_t lost() const override { return lost_; }
  bool places_known() const override { return places_known_; }

 private:
  // A disk that cannot be read ends the file: the call after the error must not come here again.
  std::optional<Record> record_at_place() {
    try {
      return file_.record_at(place_);
    } catch (const IoError&) {
      place_ = file_.size();
      last_opcode_ = Opcode::kFooter;
      throw;
    }
  }

  // Without a summary: once through the whole file for topics and counts.
  void scan() {
    contents_.counts.clear();
    for (bool more = true; more;) {
      try {
        more = walk([&](const MessageHeader& header) {
                 ++contents_.counts[header.channel_id];
                 return false;
               }).has_value();
      } catch (const IoError&) {  // reported when it is reached
        if (last_opcode_ == Opcode::kChunk && !chunk_.whole()) {
          for (const MessageIndex& index : indices_behind_chunk()) contents_.counts[index.channel_id] += index.messages;
        }
      }
    }
    place_ = kMagic.size();
    chunk_.close();
  }

  // After an error of walk(): what it took of the topic.
  void note_lost() {
    std::optional<std::size_t> lost = last_opcode_ == Opcode::kMessage ? 1 : lost_of_chunk();
    if (!lost) lost = missing_by_statistics();
    if (!lost) places_known_ = false;
    lost_ = lost.value_or(1);
    passed_ += lost_;
  }

  std::optional<std::size_t> lost_of_chunk() {
    const std::vector<MessageIndex> indices = indices_behind_chunk();
    if (indices.empty()) return std::nullopt;
    std::size_t messages = 0;
    for (const MessageIndex& index : indices) messages += is_wanted(index.channel_id) ? index.messages : 0;
    return messages - std::min(messages, given_of_chunk_);
  }

  // Empty: the file has none, or they are damaged, too.
  std::vector<MessageIndex> indices_behind_chunk() {
    std::vector<MessageIndex> indices;
    try {
      for (auto at = place_;;) {
        const auto record = file_.record_at(at);
        if (!record || record->opcode != Opcode::kMessageIndex) return indices;
        file_.look_into(*record, [&](ByteCursor cursor) { indices.push_back(take_message_index(cursor)); });
        at = record->end();
      }
    } catch (const IoError&) {
      return {};
    }
  }

  // What is neither before nor behind the damage, when there is no other one behind it. Reads the rest of the file.
  std::optional<std::size_t> missing_by_statistics() {
    std::uint64_t elsewhere = passed_;
    std::uint64_t total = 0;
    for (const auto& [id, count] : contents_.counts) total += is_wanted(id) ? count : 0;
    if (!places_known_ || total <= elsewhere) return std::nullopt;
    const std::uint64_t place = place_;
    bool whole = true;
    try {
      walk([&](const MessageHeader& header) {
        elsewhere += is_wanted(header.channel_id) ? 1 : 0;
        return false;
      });
    } catch (const IoError&) {
      whole = false;
    }
    place_ = place;
    chunk_.close();
    if (!whole || total <= elsewhere) return std::nullopt;
    return static_cast<std::size_t>(total - elsewhere);
  }

  bool is_wanted(std::uint16_t id) const {
    const auto channel = contents_.known.channels.find(id);
    return channel != contents_.known.channels.end() && topic_.has_same_messages(contents_.topic_of(channel->second));
  }

  // Goes on to the next message that `wanted` takes.
  template <typename Wanted>
  std::optional<RecordedMessage> walk(Wanted&& wanted) {
    while (true) {
      if (!chunk_.at_end()) {
        if (auto message = next_in_chunk(wanted)) return message;
        continue;
      }
      const auto record = record_at_place();
      if (!record || record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter) return std::nullopt;
      place_ = record->end();
      last_opcode_ = record->opcode;
      if (record->opcode == Opcode::kChunk) {
        if (!without_topic_.contains(record->offset)) enter_chunk(*record);
      } else if (record->opcode == Opcode::kMessage) {
        if (auto message = loose_message(*record, wanted)) return message;
      } else if (record->opcode == Opcode::kSchema || record->opcode == Opcode::kChannel) {
        contents_.note(file_, *record);
      }
    }
  }

  void enter_chunk(const Record& record) {
    given_of_chunk_ = 0;
    chunk_.open(file_, record);
  }

  // A message outside of chunks: its data are read only when wanted.
  template <typename Wanted>
  std::optional<RecordedMessage> loose_message(const Record& record, Wanted&& wanted) {
    Record start = record;
    start.length = std::min<std::uint64_t>(record.length, MessageHeader::kBytes);
    MessageHeader header;
    file_.look_into(start, [&](ByteCursor cursor) { header = take_message_header(cursor); });
    if (!wanted(header)) return std::nullopt;
    return RecordedMessage{header.log_time_ns, file_.content_of(record).substr(MessageHeader::kBytes), file_.path()};
  }

  template <typename Wanted>
  std::optional<RecordedMessage> next_in_chunk(Wanted&& wanted) {
    try {
      auto [opcode, content] = chunk_.next();
      if (opcode == Opcode::kSchema) contents_.known.add_schema(content);
      if (opcode == Opcode::kChannel) contents_.known.add_channel(content);
      if (opcode != Opcode::kMessage) return std::nullopt;
      const MessageHeader header = take_message_header(content);
      if (!wanted(header)) return std::nullopt;
      ++given_of_chunk_;
      return RecordedMessage{header.log_time_ns, content.take_bytes(content.left(), "data"), file_.path()};
    } catch (const IoError&) {
      chunk_.close();
      throw;
    }
  }

  RecordFile file_;
  Contents contents_;
  std::vector<RecordedTopic> topics_;
  RecordedTopic topic_;
  std::set<std::uint64_t> without_topic_;  // chunks, by their offsets
  std::uint64_t place_ = kMagic.size();    // of the next record
  Opcode last_opcode_ = Opcode::kHeader;
  std::uint64_t passed_ = 0;  // messages of the topic, given or lost
  std::size_t lost_ = 1;
  bool places_known_ = true;
  OpenChunk chunk_;
  std::size_t given_of_chunk_ = 0;  // messages
};

}  // namespace
}  // namespace mcap

std::unique_ptr<Recording> open_mcap(const std::filesystem::path& file) { return std::make_unique<mcap::Reader>(file); }

}  // namespace rilo::detail
