#include "io/times/point_clock.hpp"

#include <algorithm>
#include <cmath>

#include "io/stamp_difference.hpp"

namespace rilo::detail {

PointClock::PointClock(const std::optional<double>& period_s, double assumed_period_s)
    : own_period_s_(period_s.value_or(assumed_period_s)), assumed_(!period_s) {}

void PointClock::expect(std::int64_t own_ns, std::int64_t points_ns) {
  if (timed_) return learn_period(own_ns, points_ns);
  timed_ = last_ = Reading{own_ns, points_ns};
}

void PointClock::set(std::int64_t own_ns, std::int64_t points_ns) {
  if (begun_) learn_period(own_ns, points_ns);
  timed_ = last_ = Reading{own_ns, points_ns};
  begun_ = true;
}

std::int64_t PointClock::stamp_of(std::int64_t own_ns) {
  if (!last_) return own_ns;
  double periods = periods_since(*last_, own_ns);
  // Own stamps that stand still, or are late, do not count.
  if (begun_) periods = std::max(periods, 1.0);
  if (periods == 0) periods = -1;
  std::int64_t stamp_ns = 0;
  const std::int64_t step_ns = nanoseconds(periods * points_period_s_.value_or(own_period_s_));
  if (__builtin_add_overflow(last_->points_ns, step_ns, &stamp_ns)) return last_->points_ns;
  if (begun_) last_ = Reading{own_ns, stamp_ns};
  return stamp_ns;
}

double PointClock::periods_since(const Reading& reading, std::int64_t own_ns) const {
  constexpr double kLongestGapS = 1e8;  // three years: own stamps that jump farther are damaged
  const double since_s = seconds_between(reading.own_ns, own_ns);
  return std::abs(since_s) > kLongestGapS ? 1 : std::round(since_s / own_period_s_);
}

void PointClock::learn_period(std::int64_t own_ns, std::int64_t points_ns) {
  if (!assumed_) return;
  const double periods = std::max(periods_since(*timed_, own_ns), 1.0);
  const double step_s = seconds_between(timed_->points_ns, points_ns) / periods;
  if (step_s > 0) points_period_s_ = std::min(points_period_s_.value_or(step_s), step_s);
}

}  // namespace rilo::detail
