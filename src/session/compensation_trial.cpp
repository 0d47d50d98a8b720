#include "session/compensation_trial.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo {

namespace {

constexpr std::size_t kEnough = 40;  // compared sweeps
constexpr std::size_t kLeast = 10;
constexpr double kRawShare = 0.6;          // better: at least 0.75 of raw sweeps, ...
constexpr double kCompensatedShare = 0.4;  // ... at most 0.38 of compensated ones
constexpr double kMostLost = 0.1;          // of the compared sweeps
constexpr std::size_t kMostSweeps = 100;   // one that stands for longer is not compared
constexpr std::size_t kBeginning = 3;      // sweeps of a map that is still built with guesses
constexpr double kMovedM = 0.1;            // during a sweep, or ...
constexpr double kTurnedRad = 0.02;

bool registered(const SweepResult& result) {
  return result.status == OdometryStatus::kOk || result.status == OdometryStatus::kDegenerate;
}

bool tracked(const SweepResult& result) { return registered(result) || result.status == OdometryStatus::kRecovered; }

bool moved(const SweepResult& result, double period_s) {
  return period_s * result.twist.head<3>().norm() > kTurnedRad || period_s * result.twist.tail<3>().norm() > kMovedM;
}

/// What is remembered of a sweep.
struct Fit {
  bool compared = false;
  double residual_rms_m = 0;
};

/// False when it has none and its points do not lie in order.
bool give_times(Sweep& sweep, double period_s) {
  if (!sweep.times_s.empty()) return true;
  auto times = order_times(sweep.points, period_s);
  if (!times) return false;
  sweep.times_s = std::move(*times);
  return true;
}

/// Of at most `most` sweeps of `source`; with times, until enough moved.
std::vector<Fit> fits_of(ScanSource& source, const OdometryConfig& config, bool with_times, std::size_t most,
                         const std::function<bool()>& interrupted, CompensationTrial& trial) {
  std::vector<Fit> fits;
  Odometry odometry(config);
  std::size_t compared = 0;
  try {
    while (fits.size() < most && compared < kEnough && !(interrupted && interrupted())) {
      std::optional<Sweep> sweep = source.next();
      if (!sweep) break;
      const double period_s = source.info().period_s;
      trial.timed = !sweep->times_s.empty();
      if (with_times && !give_times(*sweep, period_s)) break;
      if (!with_times) sweep->times_s.clear();
      const SweepResult result = odometry.register_sweep(*sweep);
      trial.lost += with_times && !fits.empty() && !tracked(result) ? 1 : 0;
      const bool usable = fits.size() >= kBeginning && registered(result);
      fits.push_back({usable && (!with_times || moved(result, period_s)), result.stats.residual_rms_m});
      compared += with_times && fits.back().compared ? 1 : 0;
    }
  } catch (const IoError&) {
    // The run will meet and report it.
  }
  return fits;
}

}  // namespace

bool CompensationTrial::certain() const {
  return sweeps >= kLeast && static_cast<double>(lost) <= kMostLost * static_cast<double>(sweeps);
}

bool CompensationTrial::raw() const {
  return certain() && static_cast<double>(better) >= kRawShare * static_cast<double>(sweeps);
}

bool CompensationTrial::compensated() const {
  return certain() && static_cast<double>(better) <= kCompensatedShare * static_cast<double>(sweeps);
}

CompensationTrial try_compensation(const OpenSource& open, std::size_t start, OdometryConfig config,
                                   const std::function<bool()>& interrupted) {
  CompensationTrial trial;
  if (!config.preprocess.deskew) return trial;
  config.budget.sweep_ms = 0;  // what is cut depends on the machine
  // One after the other: two maps at once would be the most memory of the whole run.
  const auto fits = [&](bool with_times, std::size_t most) {
    const auto source = open();
    source->skip(start);
    return fits_of(*source, config, with_times, most, interrupted, trial);
  };
  const std::vector<Fit> compensated = fits(true, kMostSweeps);
  const std::vector<Fit> as_read = fits(false, compensated.size());
  for (std::size_t i = 0; i < as_read.size(); ++i) {
    if (!compensated[i].compared || !as_read[i].compared) continue;
    ++trial.sweeps;
    trial.better += compensated[i].residual_rms_m < as_read[i].residual_rms_m ? 1 : 0;
  }
  return trial;
}

}  // namespace rilo
