#include "session/compensation_trial.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "cloud/all_round.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/odometry/odometry.hpp"
#include "session/beam_cones.hpp"
#include "session/comparable_sweep.hpp"

namespace rilo {

namespace {

constexpr std::size_t kEnough = 40;  // compared sweeps
constexpr std::size_t kLeast = 10;
constexpr double kRawShare = 0.6;          // better: at least 0.75 of raw sweeps, ...
constexpr double kCompensatedShare = 0.4;  // ... at most 0.38 of compensated ones, but all of KITTI's
constexpr double kConesShare = 0.5;        // of the compared sweeps: mostly nearly all, or none
constexpr double kMostLost = 0.1;          // of the compared sweeps
constexpr std::size_t kMostSweeps = 300;   // one that stands for longer is not compared
constexpr std::size_t kBeginning = 3;      // sweeps of a map that is still built with guesses

bool tracked(const SweepResult& result) { return registered(result) || result.status == OdometryStatus::kRecovered; }

/// What is remembered of a sweep.
struct Fit {
  bool compared = false;
  double residual_rms_m = 0;
  ConeVerdict cones = ConeVerdict::kNothing;
};

/// Which times a sweep can have.
PointTimes times_for(const Sweep& sweep) {
  if (!sweep.times_s.empty()) return PointTimes::kAuto;
  if (order_times(sweep.points, 1)) return PointTimes::kOrder;
  return all_round(sweep.points) ? PointTimes::kAzimuth : PointTimes::kNone;
}

/// False when it cannot have those times.
bool give_times(Sweep& sweep, PointTimes times, double period_s) {
  if (times == PointTimes::kOrder) {
    sweep.times_s = order_times(sweep.points, period_s).value_or(std::vector<float>{});
  } else if (times == PointTimes::kAzimuth) {
    sweep.times_s = azimuth_times(sweep.points, period_s, SpinDirection::kClockwise);
  }
  return !sweep.times_s.empty();
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
      const double turn = detail::turn_s(source.info().period_s);
      if (with_times && fits.empty()) trial.times = times_for(*sweep);
      if (with_times && !give_times(*sweep, trial.times, turn)) break;
      if (!with_times) sweep->times_s.clear();
      const SweepResult result = odometry.register_sweep(*sweep);
      trial.lost += with_times && !fits.empty() && !tracked(result) ? 1 : 0;
      const bool usable = fits.size() >= kBeginning && registered(result);
      fits.push_back({usable && (!with_times || moved(result, turn)), result.stats.residual_rms_m});
      if (!with_times || !fits.back().compared) continue;
      fits.back().cones = on_beam_cones(*sweep, result.twist);
      ++compared;
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

bool CompensationTrial::by_cones(std::size_t so_many) const {
  return sweeps >= kLeast && static_cast<double>(so_many) >= kConesShare * static_cast<double>(sweeps);
}

bool CompensationTrial::raw() const {
  const bool fits = certain() && static_cast<double>(better) >= kRawShare * static_cast<double>(sweeps);
  // Sweeps that were simulated at one instant lie on the cones, too. With azimuth_times() the direction of the turn is
  // a guess, and the fit alone would take KITTI's compensated sweeps for raw.
  return fits && (times == PointTimes::kAzimuth ? by_cones(on_cones) : !by_cones(off_cones));
}

bool CompensationTrial::compensated() const {
  const bool fits = certain() && static_cast<double>(better) <= kCompensatedShare * static_cast<double>(sweeps);
  return by_cones(off_cones) || (fits && times != PointTimes::kAzimuth);
}

CompensationTrial try_compensation(const OpenSource& open, std::size_t start, OdometryConfig config,
                                   const std::function<bool()>& interrupted, int times_slower) {
  CompensationTrial trial;
  if (!config.preprocess.deskew) return trial;
  config.budget.sweep_ms = 0;  // what is cut depends on the machine
  // One after the other: two maps at once would be the most memory of the whole run.
  const auto fits = [&](bool with_times, std::size_t most) {
    auto source = open();
    if (times_slower > 1) source = detail::with_slower_stamps(std::move(source), times_slower);
    source->skip(start);
    return fits_of(*source, config, with_times, most, interrupted, trial);
  };
  const std::vector<Fit> compensated = fits(true, kMostSweeps);
  const std::vector<Fit> as_read = fits(false, compensated.size());
  for (std::size_t i = 0; i < as_read.size(); ++i) {
    if (!compensated[i].compared || !as_read[i].compared) continue;
    ++trial.sweeps;
    trial.better += compensated[i].residual_rms_m < as_read[i].residual_rms_m ? 1 : 0;
    trial.on_cones += compensated[i].cones == ConeVerdict::kRaw ? 1 : 0;
    trial.off_cones += compensated[i].cones == ConeVerdict::kCompensated ? 1 : 0;
  }
  return trial;
}

}  // namespace rilo
