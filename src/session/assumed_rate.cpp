#include "session/assumed_rate.hpp"

#include <cstddef>

#include <fmt/format.h>

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
}  // namespace

std::string doubtful_rate(const SourceInfo& info, const std::vector<SweepResult>& results) {
  if (!info.stamps_assumed) return "";
  const std::size_t astray = count_astray(results);
  if (astray < kFewestAstray || kAstrayOneOf * astray < results.size()) return "";
  return fmt::format(
      "{} of {} sweeps are lost, or lie where no sensor can have moved to since the sweep before: the data has no "
      "timestamps, and the {:g} Hz assumed may be wrong; give --rate, the sweeps a second",
      astray, results.size(), 1.0 / info.period_s);
}

}  // namespace rilo
