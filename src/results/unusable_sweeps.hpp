// Sweeps of which the odometry can use no point, and why.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rilo/session/session_observer.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

bool within_range(double range_m, const PreprocessConfig& config);

/// Why no point of `points` is within range; `ranges_m`: of those that are finite.
std::string why_unusable(std::size_t points, std::vector<double> ranges_m, const PreprocessConfig& config);

/// Counts such sweeps, and looks at the first one.
class UnusableSweeps final : public SessionObserver {
 public:
  explicit UnusableSweeps(const PreprocessConfig& config) : config_(config) {}
  void on_registered(const RegisteredSweep& sweep) override;
  void on_restart(const Restart& restart) override;

  /// A sentence when a tenth of the sweeps are such; empty otherwise.
  std::string warning() const;
  /// No sweep could be used.
  bool all() const { return sweeps_ > 0 && unusable_ == sweeps_; }

 private:
  PreprocessConfig config_;
  std::size_t sweeps_ = 0;
  std::size_t unusable_ = 0;
  std::string why_;  // of the first one
};

}  // namespace rilo
