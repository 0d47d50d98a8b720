#include "rilo/io/live_queue.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace rilo {

void LiveQueue::push(Message message) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    ++received_;
    waiting_.push_back(std::move(message));
    const std::size_t start_up = 2 * options_.look_ahead;
    const std::size_t most = parts_ * options_.limit + (start_up - std::min(taken_, start_up));
    while (options_.limit > 0 && waiting_.size() > most) {
      waiting_.pop_front();
      ++dropped_;
    }
  }
  arrived_.notify_one();
}

void LiveQueue::join(std::size_t parts) {
  const std::lock_guard lock(mutex_);
  parts_ = parts;
}

void LiveQueue::end_source() {
  {
    const std::lock_guard lock(mutex_);
    source_ends_ = true;
  }
  arrived_.notify_all();
}

bool LiveQueue::take_end_of_source() {
  const std::lock_guard lock(mutex_);
  if (source_ends_) taken_ = 0;
  return std::exchange(source_ends_, false);
}

void LiveQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
  }
  arrived_.notify_all();
}

std::optional<LiveQueue::Message> LiveQueue::pop(std::optional<double> longest_s) {
  std::unique_lock lock(mutex_);
  const auto ready = [this] { return closed_ || source_ends_ || !waiting_.empty(); };
  if (longest_s) {
    arrived_.wait_for(lock, std::chrono::duration<double>(*longest_s), ready);
  } else {
    arrived_.wait(lock, ready);
  }
  if (waiting_.empty() || source_ends_) return std::nullopt;
  Message message = std::move(waiting_.front());
  waiting_.pop_front();
  ++taken_;
  return message;
}

LiveQueueCounts LiveQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return {received_, dropped_, waiting_.size()};
}

}  // namespace rilo
