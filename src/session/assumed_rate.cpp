#include "session/assumed_rate.hpp"

#include <optional>

#include <fmt/format.h>

#include "io/sources/source_wrappers.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo {

namespace {
// Recordings that drop a sweep now and then stay below both.
constexpr std::size_t kFewestAstray = 3;
constexpr std::size_t kAstrayOneOf = 50;

/// Where a velocity a period apart does not lead to: at a rate that is too high, sweeps that lie farther apart are
/// lost.
std::size_t count_astray(const std::vector<SweepResult>& results) {
  std::size_t astray = 0;
  for (std::size_t i = 1; i < results.size(); ++i) {  // the first one always begins a map
    const OdometryStatus status = results[i].status;
    const bool lost = status == OdometryStatus::kLost || status == OdometryStatus::kInitialising;
    astray += lost || results[i].stats.impossible_motion ? 1 : 0;
  }
  return astray;
}

bool many(std::size_t astray, std::size_t sweeps) { return astray >= kFewestAstray && kAstrayOneOf * astray >= sweeps; }

/// Of the first sweeps of `source`; none where it has stamps.
std::vector<SweepResult> results_of(ScanSource& source, std::size_t most, const OdometryConfig& config,
                                    const std::function<bool()>& interrupted) {
  std::vector<SweepResult> results;
  Odometry odometry(config);
  try {
    while (results.size() < most && !(interrupted && interrupted())) {
      const std::optional<Sweep> sweep = source.next();
      if (!sweep || !source.info().stamps_assumed) break;
      results.push_back(odometry.register_sweep(*sweep));
    }
  } catch (const IoError&) {
    // The run will meet and report it.
  }
  return results;
}
}  // namespace

std::string RateTrial::sentence() const {
  if (!slower()) return "";
  const double slower_hz = rate_hz / kTimesSlower;
  return fmt::format(
      "the data has no timestamps; at {:g} Hz {} of the first {} sweeps are lost, or lie where no sensor can have "
      "moved to, at {:g} Hz {}: assuming {:g} Hz; give --rate, the sweeps a second",
      rate_hz, astray, sweeps, slower_hz, slower_astray, slower_hz);
}

RateTrial try_slower_rate(const OpenSource& open, std::size_t start, std::size_t most, const OdometryConfig& config,
                          const std::function<bool()>& interrupted) {
  OdometryConfig unbounded = config;
  unbounded.budget.sweep_ms = 0;  // what is cut depends on the machine
  const auto source = open();
  source->skip(start);
  const std::vector<SweepResult> assumed = results_of(*source, most, unbounded, interrupted);
  RateTrial trial;
  trial.astray = count_astray(assumed);
  if (!many(trial.astray, assumed.size())) return trial;
  const auto slower = detail::with_slower_stamps(open(), RateTrial::kTimesSlower);
  slower->skip(start);
  trial.rate_hz = 1.0 / source->info().period_s;
  trial.sweeps = assumed.size();
  trial.slower_astray = count_astray(results_of(*slower, trial.sweeps, unbounded, interrupted));
  return trial;
}

std::string doubtful_rate(const SourceInfo& info, const std::vector<SweepResult>& results, const RateTrial& trial) {
  const std::size_t astray = count_astray(results);
  if (!info.stamps_assumed || !many(astray, results.size())) return "";
  const bool no_better = trial.sweeps > 0 && !trial.slower();
  return fmt::format(
      "{} of {} sweeps are lost, or lie where no sensor can have moved to since the sweep before: the data has no "
      "timestamps, and the {:g} Hz assumed may be wrong{}; give --rate, the sweeps a second",
      astray, results.size(), 1.0 / info.period_s,
      no_better
          ? fmt::format(", or neighbouring sweeps have little in common (at {:g} Hz {} of the first {} go astray)",
                        trial.rate_hz / RateTrial::kTimesSlower, trial.slower_astray, trial.sweeps)
          : "");
}

}  // namespace rilo
