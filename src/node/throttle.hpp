// Saying what happens again and again.
#pragma once

#include <chrono>
#include <optional>

namespace rilo {

/// For what may go wrong with every message.
class Throttle {
 public:
  /// True once in ten seconds.
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (last_ && now - *last_ < std::chrono::seconds(10)) return false;
    last_ = now;
    return true;
  }

 private:
  std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace rilo
