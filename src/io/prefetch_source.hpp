// Reading ahead of processing.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "rilo/io/scan_source.hpp"

namespace rilo {

/// Reads up to `depth` sweeps ahead on a background thread, which starts at the first next(). The order and the errors
/// are those of the inner source: an exception is rethrown by the next() that would have thrown it. The destructor
/// waits for the sweep that is being read.
class PrefetchSource final : public ScanSource {
 public:
  explicit PrefetchSource(std::unique_ptr<ScanSource> inner, std::size_t depth = 4);
  ~PrefetchSource() override;
  PrefetchSource(const PrefetchSource&) = delete;
  PrefetchSource& operator=(const PrefetchSource&) = delete;

  std::optional<Sweep> next() override;
  std::size_t skip(std::size_t count) override;
  std::optional<std::size_t> size() const override { return size_; }
  std::size_t current_index() const override { return current_index_; }
  std::string current_name() const override { return current_name_; }
  SourceInfo info() const override { return info_; }

 private:
  // One outcome of the inner next(), with what the inner source said right after it.
  struct Item {
    std::optional<Sweep> sweep;  // empty with no error: the end
    std::exception_ptr error;
    std::size_t index = 0;
    std::string name;
    SourceInfo info;
  };
  void run();
  Item read_one(bool& last);
  Item pop();

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
  bool finished_ = false;  // the thread has queued its last item
  std::thread thread_;
};

}  // namespace rilo
