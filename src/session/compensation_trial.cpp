#include "rilo/session/compensation_trial.hpp"

#include <optional>
#include <utility>

#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo {

namespace {

constexpr std::size_t kEnough = 40;  // compared sweeps
constexpr std::size_t kLeast = 10;
constexpr double kRawShare = 0.6;         // better: at least 0.75 of raw sweeps, at most 0.31 of compensated ones
constexpr std::size_t kMostSweeps = 100;  // one that stands for longer is not compared
constexpr std::size_t kBeginning = 3;     // sweeps of a map that is still built with guesses
constexpr double kMovedM = 0.1;           // during a sweep, or ...
constexpr double kTurnedRad = 0.02;

bool registered(const SweepResult& result) {
  return result.status == OdometryStatus::kOk || result.status == OdometryStatus::kDegenerate;
}

bool moved(const SweepResult& result, double period_s) {
  return period_s * result.twist.head<3>().norm() > kTurnedRad || period_s * result.twist.tail<3>().norm() > kMovedM;
}

/// The sweep with the times of its order, when it has none and its points lie in order.
std::optional<Sweep> timed(const Sweep& sweep, double period_s) {
  if (!sweep.times_s.empty()) return std::nullopt;
  auto times = order_times(sweep.points, period_s);
  if (!times) return std::nullopt;
  Sweep raw = sweep;
  raw.times_s = std::move(*times);
  return raw;
}

}  // namespace

bool CompensationTrial::decided() const { return sweeps >= kLeast; }

bool CompensationTrial::raw() const {
  return decided() && static_cast<double>(better) >= kRawShare * static_cast<double>(sweeps);
}

CompensationTrial try_compensation(ScanSource& source, OdometryConfig config,
                                   const std::function<bool()>& interrupted) {
  CompensationTrial trial;
  if (!config.preprocess.deskew) return trial;
  config.budget.sweep_ms = 0;  // what is cut depends on the machine
  Odometry as_read(config);
  Odometry compensated(config);
  try {
    for (std::size_t i = 0; i < kMostSweeps && trial.sweeps < kEnough && !(interrupted && interrupted()); ++i) {
      const std::optional<Sweep> sweep = source.next();
      if (!sweep) break;
      const double period_s = source.info().period_s;
      const std::optional<Sweep> raw = timed(*sweep, period_s);
      if (!raw) break;
      const SweepResult before = as_read.register_sweep(*sweep);
      const SweepResult after = compensated.register_sweep(*raw);
      if (i < kBeginning || !registered(before) || !registered(after) || !moved(after, period_s)) continue;
      ++trial.sweeps;
      trial.better += after.stats.residual_rms_m < before.stats.residual_rms_m ? 1 : 0;
    }
  } catch (const IoError&) {
    // The run will meet and report it.
  }
  return trial;
}

}  // namespace rilo
