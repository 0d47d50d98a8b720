#include "view_thread.hpp"

#include <exception>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace rilo::view {

namespace {
constexpr int kNice = 10;
}

ViewThread::ViewThread() : work_(boost::asio::make_work_guard(io_)) {}

ViewThread::~ViewThread() {
  stop([] {});
}

void ViewThread::start(bool polite, std::function<void()> on_failure) {
  on_failure_ = std::move(on_failure);
  thread_ = std::thread([this, polite] {
    // Of this thread alone, on Linux.
    if (polite) setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
    run();
  });
}

void ViewThread::run() {
  try {
    io_.run();
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("an unknown exception");
  }
}

void ViewThread::fail(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    failure_ = why;
  }
  failed_ = true;
  on_failure_();
}

void ViewThread::stop(const std::function<void()>& last) {
  if (!thread_.joinable()) return;
  post([this, last] {
    last();
    io_.stop();
  });
  thread_.join();
}

std::string ViewThread::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace rilo::view
