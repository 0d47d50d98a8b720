#include "results/unusable_sweeps.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "console/text.hpp"
#include "evaluation/percentile.hpp"

namespace rilo {

bool within_range(double range_m, const PreprocessConfig& config) {
  return range_m >= config.min_range_m && range_m <= config.max_range_m;
}

std::string why_unusable(std::size_t points, std::vector<double> ranges_m, const PreprocessConfig& config) {
  if (points == 0) return "no points";
  if (ranges_m.empty()) return "no finite points";
  std::sort(ranges_m.begin(), ranges_m.end());
  return fmt::format(
      "no point between {} and {} m (preprocess.min_range_m, max_range_m); median range {:.3f} m: are the coordinates "
      "in metres?",
      config.min_range_m, config.max_range_m, percentile(ranges_m, 0.5));
}

void UnusableSweeps::on_registered(const RegisteredSweep& sweep) {
  ++sweeps_;
  if (sweep.result.stats.points_valid > 0 || unusable_++ > 0) return;
  std::vector<double> ranges_m;
  for (const Eigen::Vector3f& p : sweep.sweep.points) {
    if (p.allFinite()) ranges_m.push_back(p.cast<double>().norm());
  }
  why_ = why_unusable(sweep.sweep.points.size(), std::move(ranges_m), config_);
}

void UnusableSweeps::on_restart(const Restart& /*restart*/) { *this = UnusableSweeps(config_); }

std::string UnusableSweeps::warning() const {
  constexpr std::size_t kOneOf = 10;  // fewer are those of a sensor that was covered for a while
  if (kOneOf * unusable_ < sweeps_ || unusable_ == 0) return "";
  return fmt::format("{} of {} without a usable point; the first one: {}", unusable_, counted(sweeps_, "sweep"), why_);
}

}  // namespace rilo
