#include "io/ros/cloud_fields.hpp"

#include <utility>
#include <vector>

#include "io/cloud_columns.hpp"
#include "io/ros/recording_source.hpp"
#include "io/ros/scan_topic.hpp"
#include "io/source_wrappers.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

class WithFields final : public WrappedSource {
 public:
  WithFields(std::unique_ptr<ScanSource> inner, std::vector<FieldInfo> fields)
      : WrappedSource(std::move(inner)), fields_(std::move(fields)) {}

  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.fields = fields_;
    return info;
  }

 private:
  std::vector<FieldInfo> fields_;
};

// None where the first message cannot be read, which is reported when it is reached.
std::vector<FieldInfo> fields_of(Recording& recording, const SourceOptions& options) {
  try {
    const RecordedTopic topic = choose_topic({}, recording.topics(), options.topic);
    if (scan_form(topic) != ScanForm::kPointCloud2) return {};
    recording.select(topic);
    const auto message = recording.next();
    if (!message) return {};
    const PointCloud2 cloud = parse_point_cloud2(message->bytes, encoding_of(topic), message->file);
    std::vector<Field> fields;
    for (const PointField& field : cloud.fields) fields.push_back({field.name});
    return describe_fields(fields, find_roles(fields, options.time_field, message->file));
  } catch (const IoError&) {
    return {};
  }
}

}  // namespace

std::unique_ptr<ScanSource> open_with_fields(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                             const SourceOptions& options) {
  std::vector<FieldInfo> fields = fields_of(*recording, options);
  auto source = open_recording(path, std::move(recording), options);
  if (fields.empty()) return source;
  return std::make_unique<WithFields>(std::move(source), std::move(fields));
}

}  // namespace rilo::detail
