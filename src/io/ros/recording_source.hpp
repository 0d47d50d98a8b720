// Sweeps from the messages of a recording.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/byte_cursor.hpp"
#include "io/ros/recording.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// What recorded_topics() gives; reads the first message of each topic with clouds.
std::vector<TopicInfo> describe_topics(Recording& recording);

/// The clouds or packets of the topic that choose_topic() finds. @throws IoError as it does, and as
/// open_packet_topic().
std::unique_ptr<ScanSource> open_recording(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                           const SourceOptions& options);

/// The sweeps of one sensor do not fit the map of another: `found` says what came after `first`, the first one.
[[noreturn]] void reject_sensor(const BytesOrigin& origin, const std::string& found, const std::string& first);

/// Sweeps from a topic of packets. An Ouster's metadata may be a topic of the recording, too: see find_decoder().
/// @throws IoError as find_decoder().
std::unique_ptr<ScanSource> open_packet_topic(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                              const RecordedTopic& topic, const SourceOptions& options);

}  // namespace rilo::detail
