// Messages that arrive now, in the shape of a recording.
#include <string>
#include <utility>
#include <variant>

#include "io/ros/recording.hpp"
#include "rilo/io/live_queue.hpp"

namespace rilo::detail {
namespace {

class LiveRecording final : public Recording {
 public:
  explicit LiveRecording(std::shared_ptr<LiveQueue> queue)
      : queue_(std::move(queue)), topics_{{queue_->options().topic, "sensor_msgs/PointCloud2", "ros1", std::nullopt}} {}

  std::string format() const override { return "ROS topic"; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }

  void select(const RecordedTopic& /*topic*/) override {
    looking_ahead_ = selections_++ == 0;
    next_kept_ = 0;
  }

  std::optional<RecordedMessage> next() override {
    if (looking_ahead_) {
      if (kept_.size() >= queue_->options().look_ahead) return std::nullopt;
      auto message = queue_->pop(kept_.empty() ? std::nullopt : std::optional(queue_->options().look_ahead_wait_s));
      if (!message) return std::nullopt;
      kept_.push_back(std::move(*message));
      return view_of(kept_.back());
    }
    auto message = next_kept_ < kept_.size() ? std::move(kept_[next_kept_++]) : queue_->pop();
    if (!message) return std::nullopt;
    current_ = std::move(*message);
    return view_of(current_);
  }

 private:
  RecordedMessage view_of(const LiveQueue::Message& message) const {
    if (const auto* cloud = std::get_if<LiveCloud>(&message.content)) {
      return {message.received_ns, {}, "live", &cloud->message};
    }
    return {message.received_ns, std::get<std::string>(message.content), "live"};
  }

  std::shared_ptr<LiveQueue> queue_;
  std::vector<RecordedTopic> topics_;
  std::deque<LiveQueue::Message> kept_;  // of the looking ahead; a deque leaves them where they are
  std::size_t next_kept_ = 0;
  LiveQueue::Message current_;
  int selections_ = 0;
  bool looking_ahead_ = false;
};

}  // namespace

std::unique_ptr<Recording> open_live(std::shared_ptr<LiveQueue> queue) {
  return std::make_unique<LiveRecording>(std::move(queue));
}

}  // namespace rilo::detail
