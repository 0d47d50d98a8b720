// When work that can be cut short has to end.
#pragma once

#include <cstdint>
#include <functional>

namespace rilo {

/// A time on an injected clock, which it refers to; by default never, without reading a clock. The clock is read from
/// several threads at once.
class Deadline {
 public:
  using Clock = std::function<std::int64_t()>;  ///< ns

  Deadline() = default;
  Deadline(const Clock& clock, std::int64_t at_ns) : clock_(&clock), at_ns_(at_ns) {}

  bool passed() const { return passed_after(0.0); }

  /// Whether work that takes so long, begun now, would end too late.
  bool passed_after(double work_ms) const {
    return clock_ != nullptr && (*clock_)() + static_cast<std::int64_t>(work_ms * 1e6) >= at_ns_;
  }

  /// After a share (0 … 1) of the time that is left.
  Deadline after(double share) const {
    if (clock_ == nullptr) {
      return {};
    }
    const std::int64_t now_ns = (*clock_)();
    return {*clock_, now_ns + static_cast<std::int64_t>(share * static_cast<double>(at_ns_ - now_ns))};
  }

 private:
  const Clock* clock_ = nullptr;
  std::int64_t at_ns_ = 0;
};

}  // namespace rilo
