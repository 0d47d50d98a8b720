// How far a long job is, on standard error.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace rilo {

/// A bar with rate and time left on a terminal; a plain line every few seconds elsewhere; nothing when quiet.
class Progress {
 public:
  Progress(std::string what, std::optional<std::size_t> total, bool quiet);

  /// The work begins now, and not with the construction.
  void start() { begin_ = Clock::now(); }

  /// `note`: a word on the current item (a status that is worth showing).
  void update(std::size_t done, const std::string& note = {});

  /// A line of its own; the bar continues below it.
  void say(const std::string& text);

  /// Ends the bar's line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string line(std::size_t done, const std::string& note) const;

  std::string what_;
  std::optional<std::size_t> total_;
  bool quiet_;
  bool terminal_;
  Clock::time_point begin_;
  Clock::time_point shown_;
  bool open_line_ = false;
};

}  // namespace rilo
