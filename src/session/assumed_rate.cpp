#include "session/assumed_rate.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rilo {

namespace {
// Recordings that drop a sweep now and then stay below both.
constexpr std::ptrdiff_t kFewestSudden = 3;
constexpr std::ptrdiff_t kSuddenOneOf = 50;
}  // namespace

std::string doubtful_rate(const SourceInfo& info, const std::vector<SweepResult>& results) {
  if (!info.stamps_assumed) return "";
  const std::ptrdiff_t sudden =
      std::count_if(results.begin(), results.end(), [](const SweepResult& r) { return r.stats.impossible_motion; });
  if (sudden < kFewestSudden || kSuddenOneOf * sudden < std::ssize(results)) return "";
  return fmt::format(
      "{} of {} sweeps lie where no sensor can have moved to since the sweep before: the data has no "
      "timestamps, and the assumed rate seems wrong; give --rate, the sweeps a second",
      sudden, results.size());
}

}  // namespace rilo
