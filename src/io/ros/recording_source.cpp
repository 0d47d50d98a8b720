#include "io/ros/recording_source.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "io/cloud_columns.hpp"
#include "io/scan_listing.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"

namespace rilo::detail {
namespace {

std::string list_of(const std::vector<RecordedTopic>& topics) {
  std::string text;
  for (const RecordedTopic& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type +
            (topic.encoding == "ros1" || topic.encoding == "cdr" ? "" : ", encoding " + in_quotes(topic.encoding)) +
            (topic.messages ? ", " + std::to_string(*topic.messages) + " messages)" : ")");
  }
  return text.empty() ? "no topics" : text;
}

RecordedTopic choose_topic(const std::filesystem::path& path, const std::vector<RecordedTopic>& topics,
                           const std::string& wanted) {
  std::vector<RecordedTopic> clouds;
  for (const RecordedTopic& topic : topics) {
    if (is_point_cloud(topic) && (wanted.empty() || topic.name == wanted)) clouds.push_back(topic);
  }
  if (clouds.size() == 1) return clouds[0];
  if (!wanted.empty()) {
    throw IoError({path, "", list_of(topics), "PointCloud2 messages on the topic " + in_quotes(wanted),
                   "Name one of these with --topic, or leave it out when only one is a PointCloud2"});
  }
  if (clouds.empty()) {
    throw IoError({path, "", list_of(topics), "a topic of type sensor_msgs/PointCloud2 in ROS 1's or CDR encoding",
                   "Record the point clouds, not the sensor's packets"});
  }
  throw IoError({path, "", std::to_string(clouds.size()) + " PointCloud2 topics: " + list_of(clouds), "one",
                 "Choose one with --topic"});
}

}  // namespace

RecordingSource::RecordingSource(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                 const SourceOptions& options)
    : recording_(std::move(recording)),
      options_(options),
      topic_(choose_topic(path, recording_->topics(), options.topic)) {
  info_.kind = "recording";
  info_.path = path;
  info_.topic = topic_.name;
  if (topic_.messages) info_.sweeps = static_cast<std::size_t>(*topic_.messages);
  look_ahead();
}

// The first messages give the period and say whether there are point times.
void RecordingSource::look_ahead() {
  constexpr std::size_t kLookedAt = 12;
  std::vector<std::int64_t> stamps;
  std::optional<std::string> promised;
  recording_->select(topic_.name);
  for (std::size_t i = 0; i < kLookedAt; ++i) {
    try {
      const auto message = recording_->next();
      if (!message) break;
      const PointCloud2 cloud = parse_point_cloud2(message->bytes, encoding_of(topic_), message->file);
      stamps.push_back(cloud.stamp_ns);
      info_.frame_id = cloud.frame_id;
      const RawCloud columns = columns_of(cloud, options_.time_field, message->file);
      if (columns.times) promised = "field " + columns.times->field;
    } catch (const IoError&) {
      // Reported when its turn comes.
    }
  }
  recording_->select(topic_.name);
  const auto gap_s = median_gap_s(stamps);
  info_.period_s = gap_s.value_or(1 / options_.assumed_rate_hz);
  const PointTimeHints hints{options_.point_time_unit, options_.point_time_reference, gap_s, info_.period_s};
  timing_.emplace(options_, hints, info_.period_s);
  timing_->promise(promised);
}

std::optional<Sweep> RecordingSource::next() {
  while (true) {
    try {
      const auto message = recording_->next();
      if (!message) return std::nullopt;
      current_ = cursor_++;
      return decode(*message);
    } catch (const IoError& error) {
      if (options_.on_bad_sweep == OnBadSweep::kFail) throw;
      note_bad_sweep(error, info_);
    }
  }
}

std::size_t RecordingSource::skip(std::size_t count) {
  const std::size_t skipped = recording_->skip(count);
  cursor_ += skipped;
  return skipped;
}

std::string RecordingSource::current_name() const {
  return file_.string() + ", message " + std::to_string(current_ + 1) + " of " + topic_.name;
}

SourceInfo RecordingSource::info() const {
  SourceInfo info = info_;
  info.format = recording_->format();  // the compression shows on the way
  info.has_point_times = timing_->has_times();
  info.point_times = timing_->description();
  for (std::string& warning : recording_->warnings()) info.warnings.push_back(std::move(warning));
  add_bad_sweep_count(info);
  return info;
}

Sweep RecordingSource::decode(const RecordedMessage& message) {
  file_ = message.file;
  const std::string part = "message " + std::to_string(current_ + 1) + " of " + topic_.name;
  const PointCloud2 cloud = parse_point_cloud2(message.bytes, encoding_of(topic_), message.file, part);
  info_.frame_id = cloud.frame_id;
  RawCloud columns = columns_of(cloud, options_.time_field, message.file, part);
  Sweep sweep;
  sweep.stamp_ns = cloud.stamp_ns;
  sweep.points = std::move(columns.points);
  sweep.intensities = std::move(columns.intensities);
  sweep.rings = std::move(columns.rings);
  timing_->apply(columns.times, current_name(), 0, sweep);
  note_lateness(stamp_difference(message.received_ns, cloud.stamp_ns));
  return sweep;
}

// A sweep is late when it reached the recorder more than a period later than the promptest one.
void RecordingSource::note_lateness(std::int64_t late_ns) {
  usual_delay_ns_ = std::min(usual_delay_ns_.value_or(late_ns), late_ns);
  const double late_s = (static_cast<double>(late_ns) - static_cast<double>(*usual_delay_ns_)) * 1e-9;
  if (late_s <= info_.period_s) return;
  ++info_.faults.late;
  info_.faults.most_late_s = std::max(info_.faults.most_late_s, late_s);
}

}  // namespace rilo::detail
