#include "session/compensation_trial.hpp"

#include <algorithm>
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
constexpr double kRawShare = 0.6;          // better: at least 0.75 of raw sweeps, 0.69 with half the turn at 5 Hz, ...
constexpr double kCompensatedShare = 0.4;  // ... at most 0.38 of compensated ones, but all of KITTI's
constexpr double kTwoUsualTurnsS = 0.15;   // at 5 Hz sweeps are all of a slow sensor, or every second of the usual one
constexpr double kConesShare = 0.5;        // of the compared sweeps: mostly nearly all, or none
constexpr double kMostLost = 0.1;          // of the compared sweeps
constexpr std::size_t kMostSweeps = 300;   // one that stands for longer is not compared
constexpr std::size_t kManyLost = 20;      // with no more that were compared nothing becomes certain
constexpr std::size_t kBeginning = 3;      // sweeps of a map that is still built with guesses

bool mostly(std::size_t better, std::size_t sweeps) {
  return sweeps > 0 && static_cast<double>(better) >= kRawShare * static_cast<double>(sweeps);
}

bool tracked(const SweepResult& result) { return registered(result) || result.status == OdometryStatus::kRecovered; }

/// What is remembered of a sweep.
struct Fit {
  bool compared = false;
  double residual_rms_m = 0;
  ConeVerdict cones = ConeVerdict::kNothing;
};

struct Fits {
  std::vector<Fit> sweeps;
  PointTimes times = PointTimes::kNone;
  std::size_t lost = 0;
};

/// Which times a sweep can have.
PointTimes times_for(const Sweep& sweep) {
  if (!sweep.times_s.empty()) return PointTimes::kAuto;
  if (order_times(sweep.points, 1)) return PointTimes::kOrder;
  return all_round(sweep.points) ? PointTimes::kAzimuth : PointTimes::kNone;
}

/// False when it cannot have those times.
bool give_times(Sweep& sweep, PointTimes times, double turn_s) {
  if (times == PointTimes::kOrder) {
    sweep.times_s = order_times(sweep.points, turn_s).value_or(std::vector<float>{});
  } else if (times == PointTimes::kAzimuth) {
    sweep.times_s = azimuth_times(sweep.points, turn_s, SpinDirection::kClockwise);
  }
  return !sweep.times_s.empty();
}

/// Of at most `most` sweeps of `source`; with times of turns of `turn_s`, until enough moved; 0: without.
Fits fits_of(ScanSource& source, const OdometryConfig& config, double turn_s, std::size_t most,
             const std::function<bool()>& interrupted) {
  Fits fits;
  Odometry odometry(config);
  std::size_t compared = 0;
  const bool with_times = turn_s > 0;
  try {
    while (fits.sweeps.size() < most && compared < kEnough && !(interrupted && interrupted())) {
      std::optional<Sweep> sweep = source.next();
      if (!sweep) break;
      if (with_times && fits.sweeps.empty()) fits.times = times_for(*sweep);
      if (with_times && !give_times(*sweep, fits.times, turn_s)) break;
      if (!with_times) sweep->times_s.clear();
      const SweepResult result = odometry.register_sweep(*sweep);
      fits.lost += !fits.sweeps.empty() && !tracked(result) ? 1 : 0;
      const bool usable = fits.sweeps.size() >= kBeginning && registered(result);
      if (fits.lost >= kManyLost && fits.lost >= compared) break;
      fits.sweeps.push_back({usable && (!with_times || moved(result, turn_s)), result.stats.residual_rms_m});
      if (!with_times || !fits.sweeps.back().compared) continue;
      fits.sweeps.back().cones = on_beam_cones(*sweep, result.twist);
      ++compared;
    }
  } catch (const IoError&) {
    // The run will meet and report it.
  }
  return fits;
}

/// Of the sweeps that are compared in both.
CompensationTrial compared(const Fits& with_times, const Fits& other) {
  CompensationTrial trial;
  trial.times = with_times.times;
  trial.lost = with_times.lost;
  for (std::size_t i = 0; i < std::min(with_times.sweeps.size(), other.sweeps.size()); ++i) {
    const Fit& fit = with_times.sweeps[i];
    if (!fit.compared || !other.sweeps[i].compared) continue;
    ++trial.sweeps;
    trial.better += fit.residual_rms_m < other.sweeps[i].residual_rms_m ? 1 : 0;
    trial.on_cones += fit.cones == ConeVerdict::kRaw ? 1 : 0;
    trial.off_cones += fit.cones == ConeVerdict::kCompensated ? 1 : 0;
  }
  return trial;
}

}  // namespace

bool CompensationTrial::certain() const {
  return sweeps >= kLeast && static_cast<double>(lost) <= kMostLost * static_cast<double>(sweeps);
}

bool CompensationTrial::by_cones(std::size_t so_many) const {
  return sweeps >= kLeast && static_cast<double>(so_many) >= kConesShare * static_cast<double>(sweeps);
}

bool CompensationTrial::raw() const {
  const bool fits = certain() && mostly(better, sweeps);
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
  if (!config.preprocess.deskew) return {};
  config.budget.sweep_ms = 0;  // what is cut depends on the machine
  const auto opened = [&] {
    auto source = open();
    return times_slower > 1 ? detail::with_slower_stamps(std::move(source), times_slower) : std::move(source);
  };
  // One after the other: two maps at once would be the most memory of the whole run.
  const auto fits = [&](std::unique_ptr<ScanSource> source, double turn_s, std::size_t most) {
    source->skip(start);
    return fits_of(*source, config, turn_s, most, interrupted);
  };
  auto source = opened();
  double turn_s = detail::turn_s(source->info().period_s);
  Fits with_times = fits(std::move(source), turn_s, kMostSweeps);
  if (turn_s > kTwoUsualTurnsS && with_times.times != PointTimes::kAuto) {
    Fits halved = fits(opened(), turn_s / 2, kMostSweeps);
    const CompensationTrial against = compared(halved, with_times);
    if (mostly(against.better, against.sweeps)) {
      turn_s /= 2;
      with_times = std::move(halved);
    }
  }
  CompensationTrial trial = compared(with_times, fits(opened(), 0, with_times.sweeps.size()));
  trial.turn_s = turn_s;
  return trial;
}

}  // namespace rilo
