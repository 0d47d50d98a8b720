#include "io/times/sweep_period.hpp"

#include <cmath>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "geometry/median.hpp"
#include "io/stamp_difference.hpp"

namespace rilo::detail {

std::optional<double> mean_period_s(const std::vector<std::int64_t>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) steps.push_back(seconds_between(stamps[i - 1], stamps[i]));
  }
  if (steps.empty()) return std::nullopt;
  const double median = upper_median(std::span(steps));
  std::erase_if(steps, [median](double step) { return std::abs(step - median) > 0.5 * median; });
  return std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(steps.size());
}

void note_odd_period(const std::string& of, SourceInfo& info) {
  // 100 Hz and more are parts of a sweep, 1 Hz are sweeps that were thinned out: both are left a factor of two.
  constexpr double kShortest = 0.005;
  constexpr double kLongest = 2;
  if (info.period_s >= kShortest && info.period_s <= kLongest) return;
  info.warnings.push_back(
      fmt::format("the stamps of {} say that there is a sweep every {:g} s: they seem to be in another unit than "
                  "seconds; correct them, or take them away to assume a rate (--rate)",
                  of, info.period_s));
}

}  // namespace rilo::detail
