#include "io/ros/recording.hpp"

#include <algorithm>
#include <utility>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {

void add_topic(const RecordedTopic& topic, std::vector<RecordedTopic>& topics) {
  const auto same = [&](const RecordedTopic& known) { return known.has_same_messages(topic); };
  const auto known = std::find_if(topics.begin(), topics.end(), same);
  if (known == topics.end()) {
    topics.push_back(topic);
  } else if (known->messages && topic.messages) {
    *known->messages += *topic.messages;
  } else {
    known->messages.reset();
  }
}

MessageEncoding encoding_of(const RecordedTopic& topic) {
  return topic.encoding == "ros1" ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
}

std::size_t Recording::skip(std::size_t count) {
  std::size_t skipped = 0;
  while (skipped < count) {
    try {
      if (!next()) break;
      ++skipped;
    } catch (const IoError&) {
      skipped += lost();  // nobody wants these messages: that they are damaged does not matter
    }
  }
  return skipped;
}

namespace {

// Split recordings. Topics and counts of all files are known from the start.
class RecordingsInTurn final : public Recording {
 public:
  RecordingsInTurn(std::vector<std::filesystem::path> files, OpenRecording open)
      : files_(std::move(files)), open_(std::move(open)) {
    open_all();
    format_ = current_->format();
    if (files_.size() > 1) format_ += ", " + counted(files_.size(), "file");
    if (files_.size() > 1) current_.reset();  // a single one stays open: it may have been unpacked for that
  }

  std::string format() const override { return format_; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }

  void select(const RecordedTopic& topic) override {
    topic_ = topic;
    place_ = 0;
    places_known_ = true;
    if (files_.size() > 1) current_.reset();
    if (!current_) return;
    current_->select(topic);
    place_ = 1;
  }

  std::optional<RecordedMessage> next() override {
    while (current_ || open_next()) {
      if (auto message = current_->next()) return message;
      close_current();
    }
    return std::nullopt;
  }

  std::size_t lost() const override { return current_ ? current_->lost() : 1; }
  bool places_known() const override { return places_known_ && (!current_ || current_->places_known()); }

  std::size_t skip(std::size_t count) override {
    std::size_t skipped = 0;
    while (skipped < count && (current_ || open_next())) {
      skipped += current_->skip(count - skipped);
      if (skipped < count) close_current();
    }
    return skipped;
  }

  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  // Leaves out files that cannot be opened, as those after a crash or a bad copy, unless it is all of them.
  void open_all() {
    std::vector<std::filesystem::path> opened;
    std::optional<IoError> failure;
    for (const auto& file : files_) {
      try {
        current_ = open_(file);
      } catch (const IoError& error) {
        warnings_.push_back(std::string("left out: ") + error.what());
        failure = error;
        continue;
      }
      opened.push_back(file);
      for (const RecordedTopic& topic : current_->topics()) add_topic(topic, topics_);
      keep_warnings();
    }
    if (opened.empty()) throw IoError(*failure);
    files_ = std::move(opened);
  }

  // A file may lack the topic.
  bool open_next() {
    while (place_ < files_.size()) {
      current_ = open_(files_[place_++]);
      const auto& topics = current_->topics();
      const auto wanted = [&](const RecordedTopic& topic) { return topic.has_same_messages(topic_); };
      if (std::any_of(topics.begin(), topics.end(), wanted)) {
        current_->select(topic_);
        return true;
      }
      current_.reset();
    }
    return false;
  }

  void close_current() {
    keep_warnings();
    places_known_ = places_known();
    current_.reset();
  }

  void keep_warnings() {
    for (std::string& warning : current_->warnings()) {
      if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) {
        warnings_.push_back(std::move(warning));
      }
    }
  }

  std::vector<std::filesystem::path> files_;
  OpenRecording open_;
  std::string format_;
  std::vector<RecordedTopic> topics_;
  std::vector<std::string> warnings_;
  RecordedTopic topic_;
  std::unique_ptr<Recording> current_;
  std::size_t place_ = 0;
  bool places_known_ = true;  // in the files before the current one
};

}  // namespace

std::unique_ptr<Recording> open_in_turn(std::vector<std::filesystem::path> files, const OpenRecording& open) {
  return std::make_unique<RecordingsInTurn>(std::move(files), open);
}

}  // namespace rilo::detail
