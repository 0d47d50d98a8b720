#include "io/ros/mcap_writer.hpp"

#include <algorithm>

#include "io/raw_bytes.hpp"
#include "io/ros/mcap_records.hpp"

namespace rilo::detail {
namespace {

using mcap::Opcode;

constexpr std::size_t kChunkBytes = 1U << 20U;

// The fields of a record: little-endian integers, texts and blobs with their length before them.
class Fields {
 public:
  template <typename T>
  Fields& put(T value) {
    append_bytes(bytes_, value);
    return *this;
  }
  Fields& text(std::string_view text) { return put(static_cast<std::uint32_t>(text.size())).raw(text); }
  Fields& raw(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(Opcode opcode, const Fields& fields) {
  return Fields().put(opcode).put(std::uint64_t{fields.bytes().size()}).raw(fields.bytes()).bytes();
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file) : file_(file) {
  write(mcap::kMagic);
  write(record(Opcode::kHeader, Fields().text("ros2").text("rilo")));
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::string_view schema, std::string_view definition) {
  const auto id = static_cast<std::uint16_t>(counts_.size() + 1);  // a schema's number is never 0
  channels_ += record(Opcode::kSchema, Fields().put(id).text(schema).text("ros2msg").text(definition));
  channels_ += record(Opcode::kChannel, Fields().put(id).put(id).text(topic).text("cdr").put(std::uint32_t{0}));
  counts_[id] = 0;
  return id;
}

void McapWriter::add_message(std::uint16_t channel, std::int64_t stamp_ns, std::string_view cdr) {
  const auto stamp = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0));
  if (chunk_.records.empty()) {
    chunk_.records = channels_;
    chunk_.first_ns = chunk_.last_ns = stamp;
  }
  chunk_.first_ns = std::min(chunk_.first_ns, stamp);
  chunk_.last_ns = std::max(chunk_.last_ns, stamp);
  chunk_.index[channel] += Fields().put(stamp).put(std::uint64_t{chunk_.records.size()}).bytes();
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_.records += record(Opcode::kMessage, Fields().put(channel).put(sequence).put(stamp).put(stamp).raw(cdr));
  if (chunk_.records.size() > kChunkBytes) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const std::uint64_t size = chunk_.records.size();
  const std::uint64_t offset = written_;
  write(record(Opcode::kChunk, Fields()
                                   .put(chunk_.first_ns)
                                   .put(chunk_.last_ns)
                                   .put(size)
                                   .put(mcap::crc_of(chunk_.records))
                                   .text("")
                                   .put(size)
                                   .raw(chunk_.records)));
  const std::uint64_t length = written_ - offset;
  Fields offsets;
  const std::uint64_t index_offset = written_;
  for (const auto& [channel, entries] : chunk_.index) {
    offsets.put(channel).put(written_);
    write(record(Opcode::kMessageIndex, Fields().put(channel).text(entries)));
  }
  chunk_indices_ += record(Opcode::kChunkIndex, Fields()
                                                    .put(chunk_.first_ns)
                                                    .put(chunk_.last_ns)
                                                    .put(offset)
                                                    .put(length)
                                                    .text(offsets.bytes())
                                                    .put(written_ - index_offset)
                                                    .text("")
                                                    .put(size)
                                                    .put(size));
  ++chunks_;
  first_ns_ = std::min(first_ns_, chunk_.first_ns);
  last_ns_ = std::max(last_ns_, chunk_.last_ns);
  chunk_ = {};
}

void McapWriter::finish() {
  close_chunk();
  write(record(Opcode::kDataEnd, Fields().put(std::uint32_t{0})));
  const std::uint64_t summary = written_;
  write(channels_);
  write(statistics());
  write(chunk_indices_);
  write(record(Opcode::kFooter, Fields().put(summary).put(std::uint64_t{0}).put(std::uint32_t{0})));
  write(mcap::kMagic);
  file_.commit();
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  Fields counts;
  for (const auto& [channel, count] : counts_) {
    messages += count;
    counts.put(channel).put(count);
  }
  const auto channels = static_cast<std::uint32_t>(counts_.size());
  return record(Opcode::kStatistics, Fields()
                                         .put(messages)
                                         .put(static_cast<std::uint16_t>(channels))
                                         .put(channels)
                                         .put(std::uint32_t{0})  // attachments
                                         .put(std::uint32_t{0})  // metadata
                                         .put(chunks_)
                                         .put(messages > 0 ? first_ns_ : 0)
                                         .put(last_ns_)
                                         .text(counts.bytes()));
}

void McapWriter::write(std::string_view bytes) {
  file_.write(bytes);
  written_ += bytes.size();
}

}  // namespace rilo::detail
