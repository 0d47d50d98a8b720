#include "odometry/sweep_clock.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "geometry/median.hpp"

namespace rilo {

namespace {
constexpr std::int64_t kFirstPeriodNs = 100'000'000;     // until two stamps are known: most sensors spin at 10 Hz
constexpr std::int64_t kShortestStepNs = 1'000'000;      // no sensor spins at 1 kHz
constexpr std::int64_t kLongestStepNs = 10'000'000'000;  // beyond it the motion before is irrelevant
constexpr std::int64_t kLatestNs = std::numeric_limits<std::int64_t>::max() - kLongestStepNs;

/// later − earlier; 0, which no step is, where that has no representation.
std::int64_t difference(std::int64_t later, std::int64_t earlier) {
  std::int64_t result = 0;
  return __builtin_sub_overflow(later, earlier, &result) ? 0 : result;
}

bool believable(std::int64_t step_ns) { return step_ns >= kShortestStepNs && step_ns <= kLongestStepNs; }
}  // namespace

SweepTime SweepClock::advance(std::int64_t given_ns, std::int64_t to_middle_ns) {
  const std::int64_t shift_ns = difference(to_middle_ns, std::exchange(to_middle_ns_, to_middle_ns));
  if (!begun_) {
    begun_ = true;
    stamp_ns_ = given_ns_ = believed_ns_ = std::min(given_ns, kLatestNs);
    return {stamp_ns_, 0, 0};
  }
  const std::int64_t from_believed = difference(difference(given_ns, believed_ns_), since_ns_);
  const std::int64_t from_last = difference(given_ns, given_ns_);
  // Until a stamp is in doubt both are the same.
  const bool goes_on = believable(from_believed);
  const bool was_set = !goes_on && believable(from_last);
  const std::int64_t step_ns = goes_on ? from_believed : was_set ? from_last : period_ns();
  SweepTime time{0, step_ns, step_ns};
  time.stamp_ns = stamp_ns_ = std::min(stamp_ns_, kLatestNs) + time.step_ns;
  if (was_set && given_ns > stamp_ns_ && given_ns < kLatestNs) {
    time.stamp_ns = stamp_ns_ = given_ns;  // set forward: the stamps of the poses follow
  }
  given_ns_ = given_ns;
  if (goes_on || was_set) {
    const std::int64_t turn_ns = difference(time.step_ns, shift_ns);
    if (turn_ns >= kShortestStepNs) {  // else the times of the points go on in place of the stamps
      remember(turn_ns);
      time.even_ns = std::max<std::int64_t>(1, last_even_ns() + shift_ns);
    }
    believed_ns_ = given_ns;
    since_ns_ = 0;
  } else {
    since_ns_ += time.step_ns;
  }
  return time;
}

std::int64_t SweepClock::period_ns() const {
  if (count_ == 0) {
    return kFirstPeriodNs;
  }
  const std::size_t known = std::min(count_, kRemembered);
  std::array<std::int64_t, kRemembered> sorted = steps_;
  return upper_median(std::span(sorted).first(known));
}

std::int64_t SweepClock::last_even_ns() const {
  const std::int64_t period = period_ns();
  std::int64_t late = 0;  // the stamp after the tick; half of it is taken for an error of the period
  std::int64_t total = 0;
  std::int64_t ticks = 0;
  std::int64_t last = 0;
  for (std::size_t i = count_ - std::min(count_, kRemembered); i < count_; ++i) {
    const std::int64_t step = steps_[i % kRemembered];
    last = std::max<std::int64_t>(1, (late + step + period / 2) / period);
    late = (late + step - last * period) / 2;
    total += step;
    ticks += last;
  }
  return last * (total / ticks) + last * (total % ticks) / ticks;
}

void SweepClock::remember(std::int64_t step_ns) { steps_[count_++ % kRemembered] = step_ns; }

}  // namespace rilo
