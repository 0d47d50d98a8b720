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

double turn_s(double period_s) {
  constexpr double kSlowestS = 0.25;  // 5 Hz and some jitter
  constexpr double kUsualS = 0.1;
  return period_s <= kSlowestS ? period_s : period_s / std::round(period_s / kUsualS);
}

void note_left_out(double period_s, double turn_s, std::vector<std::string>& warnings) {
  if (turn_s == period_s) return;
  warnings.push_back(
      fmt::format("sweeps are {:.3g} s apart, and a turn is taken to last {:.3g} s: some were left out; times of the "
                  "points in seconds, in the data, would say it exactly",
                  period_s, turn_s));
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
