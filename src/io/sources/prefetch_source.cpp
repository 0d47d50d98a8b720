// Reading ahead of processing.
#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "io/sources/read_sweep.hpp"
#include "io/sources/source_wrappers.hpp"

namespace rilo::detail {
namespace {

class PrefetchSource final : public ScanSource {
 public:
  PrefetchSource(std::unique_ptr<ScanSource> inner, std::size_t depth)
      : inner_(std::move(inner)),
        depth_(std::max<std::size_t>(depth, 1)),
        size_(inner_->size()),
        info_(inner_->info()) {}
  ~PrefetchSource() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  PrefetchSource(const PrefetchSource&) = delete;
  PrefetchSource& operator=(const PrefetchSource&) = delete;

  std::optional<Sweep> next() override {
    if (ended_) return std::nullopt;
    Item item = pop();
    current_index_ = item.read.index;
    current_name_ = std::move(item.read.name);
    info_ = std::move(item.info);
    return item.read.take();
  }

  std::size_t skip(std::size_t count) override {
    // Before the thread has started, nothing needs to be read.
    if (!thread_.joinable()) return ended_ ? 0 : inner_->skip(count);
    std::size_t skipped = 0;
    while (skipped < count && !ended_) {
      if (!pop().read.is_end()) ++skipped;
    }
    return skipped;
  }

  std::optional<std::size_t> size() const override { return size_; }
  std::size_t current_index() const override { return current_index_; }
  std::string current_name() const override { return current_name_; }
  SourceInfo info() const override { return info_; }

 private:
  struct Item {
    ReadSweep read;
    SourceInfo info;  // right after it
  };

  Item pop() {
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !queue_.empty() || finished_; });
    if (queue_.empty()) {
      ended_ = true;  // by an error, which the first call reports
      if (!failure_) return {{std::nullopt, nullptr, current_index_, current_name_}, info_};
      return {{std::nullopt, std::exchange(failure_, nullptr), inner_->current_index(), inner_->current_name()},
              inner_->info()};
    }
    Item item = std::move(queue_.front());
    queue_.pop_front();
    ended_ = item.read.is_end();
    lock.unlock();
    changed_.notify_all();
    return item;
  }

  // An IoError concerns one sweep, and the source continues after it; anything else ends the reading, memory that is
  // exhausted included.
  void run() {
    try {
      read_all();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      finished_ = true;
    }
    changed_.notify_all();
  }

  void read_all() {
    for (bool last = false; !last;) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return stopping_ || queue_.size() < depth_; });
        if (stopping_) return;
      }
      ReadSweep read = read_sweep(*inner_);
      last = read.is_end();
      Item item{std::move(read), inner_->info()};
      {
        const std::lock_guard lock(mutex_);
        queue_.push_back(std::move(item));
        finished_ = last;
      }
      changed_.notify_all();
    }
  }

  std::unique_ptr<ScanSource> inner_;
  std::size_t depth_;
  std::optional<std::size_t> size_;
  std::size_t current_index_ = 0;
  std::string current_name_;
  SourceInfo info_;
  bool ended_ = false;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> queue_;
  bool stopping_ = false;
  bool finished_ = false;       // the thread has queued its last item
  std::exception_ptr failure_;  // that ended the reading
  std::thread thread_;
};

}  // namespace

std::unique_ptr<ScanSource> with_read_ahead(std::unique_ptr<ScanSource> inner, std::size_t depth) {
  return std::make_unique<PrefetchSource>(std::move(inner), depth);
}

}  // namespace rilo::detail
