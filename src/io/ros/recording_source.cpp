#include "io/ros/recording_source.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/bad_sweeps.hpp"
#include "io/ros/cloud_message.hpp"
#include "io/ros/scan_topic.hpp"
#include "io/stamp_difference.hpp"
#include "io/times/sweep_period.hpp"
#include "io/times/sweep_timing.hpp"
#include "io/times/time_field.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

class RecordingSource final : public ScanSource {
 public:
  // `topic`: one of recording->topics() with clouds (PointCloud2, Livox CustomMsg).
  RecordingSource(const std::filesystem::path& path, std::unique_ptr<Recording> recording, RecordedTopic topic,
                  const SourceOptions& options)
      : recording_(std::move(recording)), options_(options), topic_(std::move(topic)) {
    info_.kind = "recording";
    info_.path = path;
    info_.topic = topic_.name;
    if (topic_.messages) info_.sweeps = static_cast<std::size_t>(*topic_.messages);
    begin_timing(look_ahead());
  }

  std::optional<Sweep> next() override {
    while (true) {
      lost_ = 1;
      try {
        const auto message = next_message();
        if (!message) return std::nullopt;
        return decode(*message);
      } catch (const IoError& error) {
        if (options_.on_bad_sweep == OnBadSweep::kFail) throw;
        note_bad_sweep(error, info_, lost_);
      }
    }
  }

  std::size_t skip(std::size_t count) override {
    const std::size_t skipped = recording_->skip(count);
    note_places();
    cursor_ += skipped;
    return skipped;
  }

  std::optional<std::size_t> size() const override { return info_.sweeps; }
  std::size_t current_index() const override { return current_; }

  std::string current_name() const override { return file_.string() + ", " + current_part(); }

  SourceInfo info() const override {
    SourceInfo info = info_;
    info.format = recording_->format();  // the compression shows on the way
    info.has_point_times = timing_->has_times();
    info.point_times = timing_->description();
    if (timing_->sets_stamps()) {
      info.stamps_assumed = false;
    } else if (unstamped_) {
      info.warnings.push_back(fmt::format(
          "the messages have no stamps: {}",
          info.stamps_assumed ? fmt::format("assuming {:g} Hz (change with --rate)", options_.assumed_rate_hz())
                              : "the times when they were recorded are used"));
    }
    for (std::string& warning : timing_->warnings()) info.warnings.push_back(std::move(warning));
    for (std::string& warning : recording_->warnings()) info.warnings.push_back(std::move(warning));
    add_bad_sweep_count(info);
    if (info.places_known) {
      info.warnings.push_back(fmt::format(
          "how many messages a damaged part of the recording held is not known: only the sweeps before place {} are "
          "compared with ground truth",
          *info.places_known));
    }
    return info;
  }

 private:
  struct Arrival {
    std::int64_t header_ns = 0;
    std::int64_t received_ns = 0;
    std::size_t index = 0;
  };

  // What the first messages say about the period and the point times.
  struct FirstMessages {
    std::vector<std::int64_t> stamps;
    std::vector<std::int64_t> received;
    std::optional<std::string> promised;  // where the point times are
    std::vector<RawTimes> ends;           // of the point times
    std::vector<Arrival> of_ends;         // as long
  };

  FirstMessages look_ahead() {
    constexpr std::size_t kLookedAt = 12;
    FirstMessages first;
    recording_->select(topic_);
    for (std::size_t i = 0; i < kLookedAt; ++i) {
      CloudMessage cloud;
      std::int64_t received_ns = 0;
      try {
        const auto message = recording_->next();
        if (!message) break;
        received_ns = message->received_ns;
        parse_cloud(*message, topic_, options_.time_field, "", cloud);
        if (info_.fields.empty()) info_.fields = fields_of(*message, topic_, options_.time_field);
      } catch (const IoError&) {
        // Reported when it is reached.
      }
      if (!cloud.stamp_ns || !is_of_the_sensor(cloud)) continue;
      first.stamps.push_back(*cloud.stamp_ns);
      first.received.push_back(received_ns);
      if (!cloud.cloud.times) continue;
      first.promised = "field " + cloud.cloud.times->field;
      add_time_ends(*cloud.cloud.times, cloud.cloud.points, first.ends);
      first.of_ends.resize(first.ends.size(), {*cloud.stamp_ns, received_ns, i});
    }
    recording_->select(topic_);
    return first;
  }

  void begin_timing(const FirstMessages& first) {
    const std::vector<std::int64_t>& stamps = first.stamps;
    // ROS' stamp of nothing.
    unstamped_ = stamps.size() > 1 && std::all_of(stamps.begin(), stamps.end(), [](auto stamp) { return stamp == 0; });
    const auto period_s = mean_period_s(unstamped_ ? first.received : stamps);
    info_.stamps_assumed = unstamped_ && !period_s;
    info_.period_s = period_s.value_or(1 / options_.assumed_rate_hz());
    if (period_s) note_odd_period("the messages", info_);
    PointTimeHints hints = hints_of(topic_, options_);
    hints.period_s = period_s;
    hints.assumed_period_s = info_.period_s;
    timing_.emplace(options_, hints, info_.period_s);
    std::vector<std::int64_t> stamps_of_ends;
    for (const Arrival& arrival : first.of_ends) stamps_of_ends.push_back(stamp_of(arrival));
    timing_->promise(first.promised, first.ends, stamps_of_ends);
  }

  // Damage may take more than one message.
  std::optional<RecordedMessage> next_message() {
    try {
      auto message = recording_->next();
      if (message) current_ = cursor_++;
      return message;
    } catch (const IoError&) {
      note_places();
      lost_ = recording_->lost();
      current_ = cursor_;
      cursor_ += lost_;
      throw;
    }
  }

  void note_places() {
    if (!recording_->places_known() && !info_.places_known) info_.places_known = cursor_;
  }

  std::string current_part() const { return "message " + std::to_string(current_ + 1) + " of " + topic_.name; }

  std::int64_t stamp_of(const Arrival& arrival) const {
    if (!unstamped_) return arrival.header_ns;
    if (!info_.stamps_assumed) return arrival.received_ns;
    return nanoseconds(static_cast<double>(arrival.index) * info_.period_s);
  }

  Sweep decode(const RecordedMessage& message) {
    file_ = message.file;
    CloudMessage cloud;
    parse_cloud(message, topic_, options_.time_field, current_part(), cloud);
    check_sensor(cloud);
    RawCloud& columns = cloud.cloud;
    Sweep sweep;
    sweep.stamp_ns = stamp_of({*cloud.stamp_ns, message.received_ns, current_});
    sweep.points = std::move(columns.points);
    sweep.intensities = std::move(columns.intensities);
    sweep.rings = std::move(columns.rings);
    timing_->apply(columns.times, current_name(), 0, sweep);
    if (!unstamped_) note_lateness(stamp_difference(message.received_ns, *cloud.stamp_ns));
    return sweep;
  }

  // The first one decides.
  bool is_of_the_sensor(const CloudMessage& cloud) {
    if (sensor_.empty()) {
      sensor_ = cloud.sensor;
      info_.frame_id = cloud.frame_id;
    }
    return cloud.sensor == sensor_;
  }

  void check_sensor(const CloudMessage& cloud) {
    if (is_of_the_sensor(cloud)) return;
    reject_sensor({file_, current_part()}, "points of " + cloud.sensor, sensor_);
  }

  // A sweep is late when it reached the recorder more than a period later than the promptest one.
  void note_lateness(std::int64_t late_ns) {
    usual_delay_ns_ = std::min(usual_delay_ns_.value_or(late_ns), late_ns);
    const double late_s = (static_cast<double>(late_ns) - static_cast<double>(*usual_delay_ns_)) * 1e-9;
    if (late_s <= info_.period_s) return;
    ++info_.faults.late;
    info_.faults.most_late_s = std::max(info_.faults.most_late_s, late_s);
  }

  std::unique_ptr<Recording> recording_;
  SourceOptions options_;
  RecordedTopic topic_;
  SourceInfo info_;
  std::optional<SweepTiming> timing_;
  bool unstamped_ = false;  // the headers' stamps are zero
  std::filesystem::path file_;
  std::string sensor_;       // that of the first message
  std::size_t cursor_ = 0;   // of the next message
  std::size_t current_ = 0;  // of the last one
  std::size_t lost_ = 1;     // by the last error
  std::optional<std::int64_t> usual_delay_ns_;
};

// Of the first message that can be read.
std::string frame_of(Recording& recording, const RecordedTopic& topic) {
  if (is_packets(scan_form(topic))) return "";
  CloudMessage cloud;
  recording.select(topic);
  try {
    if (const auto message = recording.next()) parse_cloud(*message, topic, "", "", cloud);
  } catch (const IoError&) {
    // Its frame may be read all the same.
  }
  return cloud.frame_id;
}

}  // namespace

void reject_sensor(const BytesOrigin& origin, const std::string& found, const std::string& first) {
  throw IoError({origin.file, origin.part, found + " after some of " + first, "one sensor in a topic",
                 "Record each sensor on a topic of its own; where bad sweeps are skipped, the first one's are used"});
}

std::vector<TopicInfo> describe_topics(Recording& recording) {
  const std::vector<RecordedTopic> topics = recording.topics();
  const std::vector<RecordedTopic> scans = scan_topics(topics);
  std::vector<TopicInfo> described;
  for (const RecordedTopic& topic : topics) {
    const bool chosen = std::any_of(scans.begin(), scans.end(),
                                    [&](const RecordedTopic& scan) { return scan.has_same_messages(topic); });
    described.push_back(
        {topic.name, topic.type, topic.messages, chosen, chosen ? frame_of(recording, topic) : std::string()});
  }
  return described;
}

std::unique_ptr<ScanSource> open_recording(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                           const SourceOptions& options) {
  const std::vector<std::string> warnings = recording->warnings();
  if (recording->topics().empty() && !warnings.empty()) {
    throw IoError({path, "", "no topics; " + warnings.front(), "a recording with a topic of scans",
                   "Copy the recording again; where the recorder was killed early, nothing was recorded"});
  }
  const RecordedTopic topic = choose_topic(path, recording->topics(), options.topic);
  if (is_packets(scan_form(topic))) return open_packet_topic(path, std::move(recording), topic, options);
  return std::make_unique<RecordingSource>(path, std::move(recording), topic, options);
}

}  // namespace rilo::detail
