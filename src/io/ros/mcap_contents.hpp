// What an MCAP file holds, as it says itself: topics, chunks, numbers of messages.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/ros/mcap_records.hpp"
#include "io/ros/recording.hpp"

namespace rilo::detail::mcap {

struct Contents {
  Channels known;
  std::vector<ChunkIndex> chunks;                 ///< as far as they are indexed
  std::map<std::uint16_t, std::uint64_t> counts;  ///< messages by channel; empty: unknown

  /// Takes over what a record outside of chunks says, of whatever kind it is. @throws IoError when it is damaged.
  void note(RecordFile& file, const Record& record);

  /// Whether there are channels, and a schema for each that has one: a summary may lack them.
  bool channels_told() const;

  RecordedTopic topic_of(const Channel& channel) const;
  std::vector<RecordedTopic> topics() const;
};

/// Of the summary at the end of the file; empty where there is none. @throws IoError when it is damaged.
Contents read_summary(RecordFile& file);

}  // namespace rilo::detail::mcap
