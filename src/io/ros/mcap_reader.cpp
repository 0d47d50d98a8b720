// A single MCAP file, read from front to back, a chunk at a time.
#include <algorithm>
#include <memory>
#include <set>

#include "io/ros/mcap_records.hpp"
#include "io/ros/recording.hpp"
#include "io/ros/unpack.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace mcap {
namespace {

// The records of the file, and the messages inside its chunks.
class Reader final : public Recording {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {
    try {
      read_summary();
    } catch (const IoError&) {
      // A damaged summary is as good as none.
      known_ = {};
      chunks_.clear();
      counts_.clear();
    }
    if (!summary_tells()) scan();
    list_topics();
  }

  std::string format() const override { return compression_.empty() ? "mcap" : "mcap (" + compression_ + ")"; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  std::vector<std::string> warnings() const override { return file_.warnings(); }

  void select(const RecordedTopic& topic) override {
    topic_ = topic;
    place_ = kMagic.size();
    leave_chunk();
    passed_ = 0;
    places_known_ = true;
    without_topic_.clear();
    for (const ChunkIndex& chunk : chunks_) {
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

  void read_summary() {
    constexpr std::uint64_t kFooter = 20;
    if (file_.size() < 2 * kMagic.size() + kRecordHeader + kFooter) return;
    const auto footer = file_.record_at(file_.size() - kMagic.size() - kFooter - kRecordHeader);
    if (!footer || footer->opcode != Opcode::kFooter || footer->length != kFooter) {
      file_.forget_warnings();
      return;
    }
    std::uint64_t start = 0;
    file_.look_into(*footer, [&](ByteCursor cursor) { start = cursor.take<std::uint64_t>("start of the summary"); });
    if (start == 0) return;
    for (auto at = start; at < footer->offset;) {
      const auto record = file_.record_at(at);
      if (!record) break;
      at = record->end();
      note(*record);
    }
  }

  void note(const Record& record) {
    switch (record.opcode) {
      case Opcode::kSchema:
        return file_.look_into(record, [&](ByteCursor cursor) { known_.add_schema(cursor); });
      case Opcode::kChannel:
        return file_.look_into(record, [&](ByteCursor cursor) { known_.add_channel(cursor); });
      case Opcode::kChunkIndex:
        return file_.look_into(record, [&](ByteCursor cursor) { chunks_.push_back(take_chunk_index(cursor)); });
      case Opcode::kStatistics:
        return file_.look_into(record, [&](ByteCursor cursor) { counts_ = take_message_counts(cursor); });
      default:
        return;
    }
  }

  // A summary may lack the channels or their schemas.
  bool summary_tells() const {
    const auto is_told = [&](const auto& channel) {
      return channel.second.schema_id == 0 || known_.schemas.contains(channel.second.schema_id);
    };
    return !known_.channels.empty() && std::all_of(known_.channels.begin(), known_.channels.end(), is_told);
  }

  // Without a summary: once through the whole file for topics and counts.
  void scan() {
    counts_.clear();
    for (bool more = true; more;) {
      try {
        more = walk([&](const MessageHeader& header) {
                 ++counts_[header.channel_id];
                 return false;
               }).has_value();
      } catch (const IoError&) {  // reported when it is reached
        if (last_opcode_ == Opcode::kChunk && !chunk_read_) {
          for (const MessageIndex& index : indices_behind_chunk()) counts_[index.channel_id] += index.messages;
        }
      }
    }
    place_ = kMagic.size();
    leave_chunk();
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
    for (const auto& [id, count] : counts_) total += is_wanted(id) ? count : 0;
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
    leave_chunk();
    if (!whole || total <= elsewhere) return std::nullopt;
    return static_cast<std::size_t>(total - elsewhere);
  }

  void list_topics() {
    for (const auto& [id, channel] : known_.channels) {
      RecordedTopic topic = topic_of(channel);
      if (!counts_.empty()) topic.messages = counts_[id];
      add_topic(topic, topics_);
    }
  }

  RecordedTopic topic_of(const Channel& channel) const {
    const auto schema = known_.schemas.find(channel.schema_id);
    return {channel.topic, schema == known_.schemas.end() ? "" : schema->second, channel.encoding, {}};
  }

  bool is_wanted(std::uint16_t id) const {
    const auto channel = known_.channels.find(id);
    return channel != known_.channels.end() && topic_.has_same_messages(topic_of(channel->second));
  }

  // Goes on to the next message that `wanted` takes.
  template <typename Wanted>
  std::optional<RecordedMessage> walk(Wanted&& wanted) {
    while (true) {
      if (in_chunk()) {
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
        note(*record);
      }
    }
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

  bool in_chunk() const { return chunk_place_ < chunk_.size(); }
  void leave_chunk() {
    chunk_.clear();
    chunk_place_ = 0;
  }

  void enter_chunk(const Record& record) {
    leave_chunk();
    chunk_read_ = false;
    given_of_chunk_ = 0;
    chunk_origin_ = {file_.path(), "chunk at byte " + std::to_string(record.offset)};
    file_.look_into(record, [&](ByteCursor cursor) {
      const ChunkHeader header = take_chunk_header(cursor);
      const auto size = cursor.take<std::uint64_t>("size of the records");
      const std::string_view packed = cursor.take_bytes(static_cast<std::size_t>(size), "records");
      try {
        unpack(header, packed);
      } catch (const IoError&) {
        leave_chunk();
        throw;
      }
    });
    chunk_read_ = true;
  }

  void unpack(const ChunkHeader& header, std::string_view packed) {
    const auto limit = static_cast<std::size_t>(std::min<std::uint64_t>(header.unpacked_bytes, kLargestUnpacked));
    if (header.compression == "zstd") {
      unpack_zstd(packed, limit, chunk_origin_, chunk_);
    } else if (header.compression == "lz4") {
      unpack_lz4(packed, limit, chunk_origin_, chunk_);
    } else if (header.compression.empty()) {
      chunk_.assign(packed.begin(), packed.end());
    } else {
      reject_chunk("the compression " + in_quotes(header.compression), "zstd, lz4 or none");
    }
    if (!header.compression.empty()) compression_ = header.compression;
    if (chunk_.size() != header.unpacked_bytes) {
      reject_chunk(counted(chunk_.size(), "byte") + " unpacked", std::to_string(header.unpacked_bytes));
    }
    const std::uint32_t crc = crc_of({chunk_.data(), chunk_.size()});
    if (header.crc != 0 && crc != header.crc) {
      reject_chunk("CRC " + std::to_string(crc), "CRC " + std::to_string(header.crc));
    }
  }

  [[noreturn]] void reject_chunk(const std::string& found, const std::string& expected) const {
    throw IoError({file_.path(), chunk_origin_.part, found, expected,
                   "The file is damaged: copy it again, or leave the chunk out with --skip-bad-sweeps"});
  }

  template <typename Wanted>
  std::optional<RecordedMessage> next_in_chunk(Wanted&& wanted) {
    ByteCursor rest(std::string_view(chunk_.data(), chunk_.size()).substr(chunk_place_), chunk_origin_, chunk_place_);
    try {
      const auto opcode = static_cast<Opcode>(rest.take<std::uint8_t>("opcode"));
      const auto length = rest.take<std::uint64_t>("length");
      const std::size_t start = chunk_place_ + rest.offset();
      const std::string_view content = rest.take_bytes(static_cast<std::size_t>(length), "record");
      ByteCursor cursor(content, chunk_origin_, start);
      chunk_place_ += rest.offset();
      if (opcode == Opcode::kSchema) known_.add_schema(cursor);
      if (opcode == Opcode::kChannel) known_.add_channel(cursor);
      if (opcode != Opcode::kMessage) return std::nullopt;
      const MessageHeader header = take_message_header(cursor);
      if (!wanted(header)) return std::nullopt;
      ++given_of_chunk_;
      return RecordedMessage{header.log_time_ns, content.substr(cursor.offset()), file_.path()};
    } catch (const IoError&) {
      leave_chunk();
      throw;
    }
  }

  RecordFile file_;
  Channels known_;
  std::vector<ChunkIndex> chunks_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::vector<RecordedTopic> topics_;
  std::string compression_;
  RecordedTopic topic_;
  std::set<std::uint64_t> without_topic_;
  std::uint64_t place_ = kMagic.size();  // of the next record
  Opcode last_opcode_ = Opcode::kHeader;
  std::uint64_t passed_ = 0;  // messages of the topic, given or lost
  std::size_t lost_ = 1;
  bool places_known_ = true;
  std::vector<char> chunk_;
  std::size_t chunk_place_ = 0;
  bool chunk_read_ = false;         // it was unpacked, and its CRC is right
  std::size_t given_of_chunk_ = 0;  // messages
  BytesOrigin chunk_origin_;
};

}  // namespace
}  // namespace mcap

std::unique_ptr<Recording> open_mcap(const std::filesystem::path& file) { return std::make_unique<mcap::Reader>(file); }

}  // namespace rilo::detail
