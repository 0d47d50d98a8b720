// The viewer's own thread. What goes wrong there ends the viewer and never the run.
#pragma once

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace rilo::view {

/// Runs what is posted, one after the other. An exception ends it: `on_failure` is called, there, and nothing is run
/// any more.
class ViewThread {
 public:
  ViewThread();
  ~ViewThread();
  ViewThread(const ViewThread&) = delete;
  ViewThread& operator=(const ViewThread&) = delete;

  boost::asio::io_context& io() { return io_; }

  /// `polite`: behind the odometry, which goes first. Once.
  void start(bool polite, std::function<void()> on_failure);

  template <typename Work>
  void post(Work&& work) {
    // Nobody would run it, and it would be kept for ever.
    if (!failed_) boost::asio::post(io_, std::forward<Work>(work));
  }

  /// Runs `last`, unless it has failed, and ends.
  void stop(const std::function<void()>& last);

  bool failed() const { return failed_; }
  /// Why; empty: it has not failed.
  std::string failure() const;

 private:
  void run();
  void fail(const std::string& why);

  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::function<void()> on_failure_;
  std::atomic<bool> failed_ = false;
  mutable std::mutex mutex_;
  std::string failure_;
  std::thread thread_;
};

}  // namespace rilo::view
