// What fits into the time that a sweep may take.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Work whose time is learnt, since it cannot be stopped half-way or has to be left room for.
enum class Work : std::uint8_t {
  kPrepare,      ///< preprocessing, per point of the raw sweep
  kRest,         ///< all that follows on a sweep in no doubt, without the coarse stage; per share of the points
  kCoarseStart,  ///< one start of the coarse stage with all its points, its clouds included
  kSettle,       ///< from the registration to the insertion into the map
  kInsert,       ///< insertion into the map, per point
};
inline constexpr std::size_t kWorkCount = 5;

/// Usual time with a margin, as TCP reckons its time-outs (Jacobson 1988): the mean and twice the mean deviation of
/// about the last five.
class UsualTime {
 public:
  static constexpr double kSlowest = 2.0;  ///< times the mean; beyond it a time is an accident rather than a trend

  bool known() const { return mean_ > 0.0; }
  double mean() const { return mean_; }
  double upper() const { return mean_ + 2.0 * deviation_; }
  void learn(double value);

 private:
  double mean_ = 0.0;
  double deviation_ = 0.0;
};

/// Shares of the points that a sweep can afford, 0 … 1.
struct PointShares {
  double raw = 1.0;     ///< of the raw sweep
  double source = 1.0;  ///< of the configured number of source points
  bool cut() const { return raw < 1.0 || source < 1.0; }
};

/// Knows the budget and what work costs. Everything stays reproducible only while nothing is cut, since times are not.
class TimeBudget {
 public:
  /// @param source_points of a sweep that is not cut.
  TimeBudget(const TimeBudgetConfig& config, int source_points) : config_(config), source_points_(source_points) {}

  bool limited() const { return config_.sweep_ms > 0.0; }

  /// When a sweep should end, after its begin: the rest of the budget is for what cannot be foreseen.
  double target_ms() const;

  /// What a sweep of so many raw points can afford. One in doubt (the second of a map, one after a loss) needs time to
  /// be searched for.
  PointShares affordable(std::size_t raw_points, bool first, bool in_doubt) const;

  /// Share of the points for which work that takes so long for all of them fits into the time left.
  double share_in_time(double work_ms, double left_ms) const;

  /// Usual time of so many units of work, with a margin; before the first one a guess, from the work that is known.
  double ms(Work work, double units = 1.0) const;

  /// Learns from finished work.
  void learn(Work work, double units, double took_ms);

  /// Whether the registration of a sweep in doubt ran out of time: the next one gets fewer points, so that all of the
  /// search fits.
  void learn_doubt(bool out_of_time);

  void reset() { *this = TimeBudget(config_, static_cast<int>(source_points_)); }

  static constexpr double kLeastShare = 0.1;  ///< with fewer points a sweep is not registered reliably

 private:
  /// Least work of a sweep in doubt, in usual ones; not cut it has 6 to 10 times as much.
  static constexpr double kDoubtfulWork = 3.0;

  double guess(Work work) const;

  TimeBudgetConfig config_;
  double source_points_;
  std::array<UsualTime, kWorkCount> times_;  // per unit
  double doubtful_work_ = kDoubtfulWork;
};

}  // namespace rilo
