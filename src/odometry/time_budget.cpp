#include "odometry/time_budget.hpp"

#include <algorithm>

namespace rilo {

namespace {
constexpr double kTarget = 0.8;      // of the budget: sweeps differ by about a fifth
constexpr double kLargestCut = 0.5;  // of the points, from one sweep to the next: one slow sweep is no trend
constexpr double kRecovery = 1.05;   // growth of the share per sweep while there is time to spare
constexpr double kSpare = 0.7;       // of the budget: below it there is
constexpr double kSmoothing = 0.2;   // of the usual times: about five sweeps
}  // namespace

bool TimeBudget::coarse_fits(double elapsed_ms) const {
  // What is before the coarse stage has passed already: half of the usual time is a guess of what comes after it.
  return !limited() || elapsed_ms + coarse_start_ms_ + 0.5 * usual_ms_ <= config_.sweep_ms;
}

void TimeBudget::learn(double total_ms, double coarse_ms, int coarse_starts) {
  if (!limited()) {
    return;
  }
  const double usual = total_ms - coarse_ms;
  usual_ms_ = usual_ms_ > 0.0 ? usual_ms_ + kSmoothing * (usual - usual_ms_) : usual;
  if (coarse_starts > 0) {
    const double start = coarse_ms / coarse_starts;
    coarse_start_ms_ = coarse_start_ms_ > 0.0 ? coarse_start_ms_ + kSmoothing * (start - coarse_start_ms_) : start;
  }
  const double ratio = usual / (kTarget * config_.sweep_ms);
  if (ratio > 1.0) {
    share_ = std::max(kLeastShare, share_ * std::max(kLargestCut, 1.0 / ratio));
  } else if (usual < kSpare * config_.sweep_ms) {
    share_ = std::min(1.0, share_ * kRecovery);
  }
}

}  // namespace rilo
