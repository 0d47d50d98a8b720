// The clock of points whose times count from an epoch, for the sweeps that lack such times.
#pragma once

#include <cstdint>
#include <optional>

namespace rilo::detail {

/// A sweep without times has a stamp of another clock (a header, a name, the assumed rate): among those that the points
/// stamp it may be years away. All that its own stamp tells is how many periods it lies from another sweep.
class PointClock {
 public:
  /// `period_s`: of the sweeps, by their own stamps. Without it those are assumed, and the points' clock tells it.
  PointClock(const std::optional<double>& period_s, double assumed_period_s);

  /// Before the first sweep: one that is still to come.
  void expect(std::int64_t own_ns, std::int64_t points_ns);

  /// The sweep was stamped by its points.
  void set(std::int64_t own_ns, std::int64_t points_ns);

  /// Of a sweep without times: whole periods after the sweep before it, or, when that is the first, before the first
  /// expected one. Its own stamp where no sweep shows the clock.
  std::int64_t stamp_of(std::int64_t own_ns);

 private:
  struct Reading {
    std::int64_t own_ns = 0;
    std::int64_t points_ns = 0;
  };

  double periods_since(const Reading& reading, std::int64_t own_ns) const;
  void learn_period(std::int64_t own_ns, std::int64_t points_ns);

  double own_period_s_;
  bool assumed_;
  std::optional<double> points_period_s_;  // the least step: others may be gaps
  std::optional<Reading> timed_;           // the last one, or the first that is expected
  std::optional<Reading> last_;            // with or without times
  bool begun_ = false;                     // with a sweep that has times
};

}  // namespace rilo::detail
