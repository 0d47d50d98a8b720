// Sweeps from the messages of a recording.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/ros/recording.hpp"
#include "io/sweep_timing.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

class RecordingSource final : public ScanSource {
 public:
  /// `topic`: one of recording->topics() with clouds (PointCloud2, Livox CustomMsg).
  RecordingSource(const std::filesystem::path& path, std::unique_ptr<Recording> recording, RecordedTopic topic,
                  const SourceOptions& options);

  std::optional<Sweep> next() override;
  std::size_t skip(std::size_t count) override;
  std::optional<std::size_t> size() const override { return info_.sweeps; }
  std::size_t current_index() const override { return current_; }
  std::string current_name() const override;
  SourceInfo info() const override;

 private:
  void look_ahead();
  Sweep decode(const RecordedMessage& message);
  void note_lateness(std::int64_t late_ns);

  std::unique_ptr<Recording> recording_;
  SourceOptions options_;
  RecordedTopic topic_;
  SourceInfo info_;
  std::optional<SweepTiming> timing_;
  std::filesystem::path file_;
  std::size_t cursor_ = 0;   // of the next message
  std::size_t current_ = 0;  // of the last one
  std::optional<std::int64_t> usual_delay_ns_;
};

/// What recorded_topics() gives; reads the first message of each topic with clouds.
std::vector<TopicInfo> describe_topics(Recording& recording);

/// The clouds or packets of the topic that choose_topic() finds. @throws IoError as it does, and as
/// open_packet_topic().
std::unique_ptr<ScanSource> open_recording(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                           const SourceOptions& options);

}  // namespace rilo::detail
