#include "io/ros/cloud_message.hpp"

#include <utility>

#include "io/clouds/cloud_columns.hpp"
#include "io/ros/driver_messages.hpp"
#include "io/ros/scan_topic.hpp"
#include "io/text.hpp"

namespace rilo::detail {
namespace {

// The message itself, or what its bytes say, kept in `parsed`.
const PointCloud2& cloud_in(const RecordedMessage& message, const RecordedTopic& topic, const std::string& part,
                            PointCloud2& parsed) {
  if (message.cloud != nullptr) return *message.cloud;
  parsed = parse_point_cloud2(message.bytes, encoding_of(topic), message.file, part);
  return parsed;
}

}  // namespace

void parse_cloud(const RecordedMessage& message, const RecordedTopic& topic, const std::string& time_field,
                 const std::string& part, CloudMessage& into) {
  if (scan_form(topic) == ScanForm::kLivoxCustom) {
    LivoxMessage livox = parse_livox(message.bytes, encoding_of(topic), {message.file, part});
    const std::string sensor = "LiDAR " + std::to_string(livox.lidar_id) + " in frame " + in_quotes(livox.frame_id);
    into = {livox.stamp_ns, std::move(livox.frame_id), std::move(livox.cloud), sensor};
    return;
  }
  PointCloud2 parsed;
  const PointCloud2& cloud = cloud_in(message, topic, part, parsed);
  into.stamp_ns = cloud.stamp_ns;
  into.frame_id = cloud.frame_id;
  into.sensor = "frame " + in_quotes(cloud.frame_id);
  into.cloud = columns_of(cloud, time_field, message.file, part);
}

std::vector<FieldInfo> fields_of(const RecordedMessage& message, const RecordedTopic& topic,
                                 const std::string& time_field) {
  if (scan_form(topic) != ScanForm::kPointCloud2) return {};
  PointCloud2 parsed;
  std::vector<Field> fields;
  for (const PointField& field : cloud_in(message, topic, "", parsed).fields) fields.push_back({field.name});
  return describe_fields(fields, find_roles(fields, time_field, {message.file}));
}

PointTimeHints hints_of(const RecordedTopic& topic, const SourceOptions& options) {
  PointTimeHints hints{options.point_time_unit, options.point_time_reference, {}, 0};
  if (scan_form(topic) == ScanForm::kLivoxCustom) {  // by definition of the message
    hints.unit = PointTimeUnit::kNanoseconds;
    hints.unit_certain = true;
    hints.reference = PointTimeReference::kStamp;
  }
  return hints;
}

}  // namespace rilo::detail
