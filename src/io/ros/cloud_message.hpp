// One message of a topic of clouds, whichever type it has: PointCloud2 or Livox' CustomMsg.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/ros/recording.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

struct CloudMessage {
  std::optional<std::int64_t> stamp_ns;
  std::string frame_id;
  RawCloud cloud;
  std::string sensor;  ///< what tells the sensors of one topic apart
};

/// Stamp and frame are set even when it throws because of the points. `part`: of the recording, for messages.
/// @throws IoError
void parse_cloud(const RecordedMessage& message, const RecordedTopic& topic, const std::string& time_field,
                 const std::string& part, CloudMessage& into);

/// Of a PointCloud2 that has x, y and z; a CustomMsg's are always the same. @throws IoError
std::vector<FieldInfo> fields_of(const RecordedMessage& message, const RecordedTopic& topic,
                                 const std::string& time_field);

/// What options and the type of the messages say about the times of the points.
PointTimeHints hints_of(const RecordedTopic& topic, const SourceOptions& options);

}  // namespace rilo::detail
