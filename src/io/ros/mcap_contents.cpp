#include "io/ros/mcap_contents.hpp"

#include <algorithm>

namespace rilo::detail::mcap {
namespace {

// Where the summary begins; 0: there is none.
std::uint64_t summary_start(RecordFile& file, const Record& footer) {
  std::uint64_t start = 0;
  file.look_into(footer, [&](ByteCursor cursor) { start = cursor.take<std::uint64_t>("start of the summary"); });
  return start;
}

}  // namespace

void Contents::note(RecordFile& file, const Record& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      return file.look_into(record, [&](ByteCursor cursor) { known.add_schema(cursor); });
    case Opcode::kChannel:
      return file.look_into(record, [&](ByteCursor cursor) { known.add_channel(cursor); });
    case Opcode::kChunkIndex:
      return file.look_into(record, [&](ByteCursor cursor) { chunks.push_back(take_chunk_index(cursor)); });
    case Opcode::kStatistics:
      return file.look_into(record, [&](ByteCursor cursor) { counts = take_message_counts(cursor); });
    default:
      return;
  }
}

bool Contents::channels_told() const {
  const auto is_told = [&](const auto& channel) {
    return channel.second.schema_id == 0 || known.schemas.contains(channel.second.schema_id);
  };
  return !known.channels.empty() && std::all_of(known.channels.begin(), known.channels.end(), is_told);
}

RecordedTopic Contents::topic_of(const Channel& channel) const {
  const auto schema = known.schemas.find(channel.schema_id);
  return {channel.topic, schema == known.schemas.end() ? "" : schema->second, channel.encoding, {}};
}

std::vector<RecordedTopic> Contents::topics() const {
  std::vector<RecordedTopic> topics;
  for (const auto& [id, channel] : known.channels) {
    RecordedTopic topic = topic_of(channel);
    const auto count = counts.find(id);
    if (!counts.empty()) topic.messages = count == counts.end() ? 0 : count->second;
    add_topic(topic, topics);
  }
  return topics;
}

Contents read_summary(RecordFile& file) {
  constexpr std::uint64_t kFooter = 20;
  if (file.size() < 2 * kMagic.size() + kRecordHeader + kFooter) return {};
  const auto footer = file.record_at(file.size() - kMagic.size() - kFooter - kRecordHeader);
  if (!footer || footer->opcode != Opcode::kFooter || footer->length != kFooter) {
    file.forget_warnings();
    return {};
  }
  Contents contents;
  const std::uint64_t start = summary_start(file, *footer);
  for (std::uint64_t at = start; start != 0 && at < footer->offset;) {
    const auto record = file.record_at(at);
    if (!record) break;
    at = record->end();
    contents.note(file, *record);
  }
  return contents;
}

}  // namespace rilo::detail::mcap
