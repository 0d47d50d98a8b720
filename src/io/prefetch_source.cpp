#include "io/prefetch_source.hpp"

#include <algorithm>
#include <utility>

#include "rilo/io/io_error.hpp"

namespace rilo {

PrefetchSource::PrefetchSource(std::unique_ptr<ScanSource> inner, std::size_t depth)
    : inner_(std::move(inner)), depth_(std::max<std::size_t>(depth, 1)), size_(inner_->size()), info_(inner_->info()) {}

PrefetchSource::~PrefetchSource() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::optional<Sweep> PrefetchSource::next() {
  if (ended_) return std::nullopt;
  Item item = pop();
  current_index_ = item.index;
  current_name_ = std::move(item.name);
  info_ = std::move(item.info);
  if (item.error) std::rethrow_exception(item.error);
  return std::move(item.sweep);
}

std::size_t PrefetchSource::skip(std::size_t count) {
  // Before the thread has started, nothing needs to be read.
  if (!thread_.joinable()) return ended_ ? 0 : inner_->skip(count);
  std::size_t skipped = 0;
  while (skipped < count && !ended_) {
    const Item item = pop();
    if (item.sweep || item.error) ++skipped;
  }
  return skipped;
}

PrefetchSource::Item PrefetchSource::pop() {
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !queue_.empty() || finished_; });
  // After an error that ended the reading, there is nothing more.
  if (queue_.empty()) {
    ended_ = true;
    return {std::nullopt, nullptr, current_index_, current_name_, info_};
  }
  Item item = std::move(queue_.front());
  queue_.pop_front();
  ended_ = !item.sweep && !item.error;
  lock.unlock();
  changed_.notify_all();
  return item;
}

void PrefetchSource::run() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || queue_.size() < depth_; });
      if (stopping_) return;
    }
    bool last = false;
    Item item = read_one(last);
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(item));
      finished_ = last;
    }
    changed_.notify_all();
    if (last) return;
  }
}

// An IoError concerns one sweep, and the source continues after it; anything else ends the reading.
PrefetchSource::Item PrefetchSource::read_one(bool& last) {
  Item item;
  try {
    item.sweep = inner_->next();
    last = !item.sweep;
  } catch (const IoError&) {
    item.error = std::current_exception();
  } catch (...) {
    item.error = std::current_exception();
    last = true;
  }
  item.index = inner_->current_index();
  item.name = inner_->current_name();
  item.info = inner_->info();
  return item;
}

}  // namespace rilo
