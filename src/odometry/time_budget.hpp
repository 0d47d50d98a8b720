// Less work per sweep when time is short.
#pragma once

#include <cstdint>

#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Keeps sweeps within a budget: the next one gets fewer points when the last took too long and more again when there
/// is time to spare, and the coarse stage is skipped, or aborted, when it would not end in time. Everything stays
/// reproducible only while nothing is cut, since times are not.
class TimeBudget {
 public:
  explicit TimeBudget(const TimeBudgetConfig& config) : config_(config) {}

  bool limited() const { return config_.sweep_ms > 0.0; }

  /// Share of the configured number of points that the next sweep should have, kLeastShare … 1.
  double point_share() const { return share_; }

  /// Whether one run of the coarse stage, as long as they usually take, would end within the budget; `elapsed_ms`:
  /// since the sweep began. The rest of the sweep is reckoned with.
  bool coarse_fits(double elapsed_ms) const;

  /// Learns from a finished sweep: its time, and that of its coarse stage with how many starts it tried.
  void learn(double total_ms, double coarse_ms, int coarse_starts);

  void reset() { *this = TimeBudget(config_); }

  static constexpr double kLeastShare = 0.1;  ///< with fewer points a sweep is not registered reliably

 private:
  TimeBudgetConfig config_;
  double share_ = 1.0;
  double usual_ms_ = 0.0;         // of a sweep without its coarse stage
  double coarse_start_ms_ = 0.0;  // of one start of the coarse stage, its clouds included
};

}  // namespace rilo
