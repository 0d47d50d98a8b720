#include "console/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

#include <fmt/format.h>

#include "console/text.hpp"

namespace rilo {

namespace {
constexpr std::chrono::milliseconds kBarInterval{100};
constexpr std::chrono::seconds kLineInterval{5};
constexpr std::size_t kBarWidth = 30;
const std::string kClearLine = "\r\033[K";

// A closed standard error is not a reason to stop: unlike fmt::print, this does not throw.
void show(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(std::string what, std::optional<std::size_t> total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      shown_(begin_) {}

void Progress::update(std::size_t done, const std::string& note) {
  const auto now = Clock::now();
  const auto interval = terminal_ ? Clock::duration(kBarInterval) : Clock::duration(kLineInterval);
  const bool last = total_ && done == *total_;
  if (quiet_ || (now - shown_ < interval && !(last && terminal_))) return;
  shown_ = now;
  open_line_ = terminal_;
  show(terminal_ ? kClearLine + line(done, note) : line(done, note) + "\n");
}

std::string Progress::line(std::size_t done, const std::string& note) const {
  const double seconds = std::max(1e-9, std::chrono::duration<double>(shown_ - begin_).count());
  const double rate = static_cast<double>(done) / seconds;
  if (!total_ || *total_ == 0) return fmt::format("{} {}, {:.1f}/s {}", what_, counted(done, "sweep"), rate, note);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(*total_));
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(kBarWidth));
  const double left = rate > 0.0 ? static_cast<double>(*total_ - std::min(done, *total_)) / rate : 0.0;
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  return fmt::format("{} [{}] {}/{}  {:.1f}/s  {:.0f} s left  {}", what_, bar, done, *total_, rate, left, note);
}

void Progress::say(const std::string& text) {
  if (quiet_) return;
  show((terminal_ ? kClearLine : "") + printable(text) + "\n");
}

void Progress::finish() {
  if (open_line_) {
    show("\n");
    open_line_ = false;
  }
}

}  // namespace rilo
