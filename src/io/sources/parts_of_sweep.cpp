#include "io/sources/parts_of_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/degrees.hpp"

namespace rilo::detail {
namespace {

constexpr double kShortestS = 0.001;     // below, the stamps are in another unit
constexpr double kLongestPartS = 0.075;  // 13 Hz
constexpr double kLongestTurnS = 0.25;
constexpr double kUsualSweepS = 0.1;
// Of the points that lie in cells of the first one's: 0.74 to 1 of simulated sensors that turn, 0.33 at most of an Avia
// or a Mid-360 at 20 and 50 Hz.
constexpr double kSeenAgain = 0.5;
constexpr double kCellDeg = 0.5;
constexpr std::size_t kAzimuths = 720;
constexpr std::size_t kElevations = 361;
constexpr std::size_t kPointsCompared = 5000;

std::optional<std::size_t> cell_of(const Eigen::Vector3f& point) {
  const Eigen::Vector3d p = point.cast<double>();
  if (!p.allFinite() || p.head<2>().isZero()) return std::nullopt;
  const double azimuth_deg = 180.0 + kDegPerRad * std::atan2(p.y(), p.x());
  const double elevation_deg = 90.0 + kDegPerRad * std::atan2(p.z(), p.head<2>().norm());
  const std::size_t azimuth = std::min(static_cast<std::size_t>(azimuth_deg / kCellDeg), kAzimuths - 1);
  return azimuth * kElevations + static_cast<std::size_t>(elevation_deg / kCellDeg);
}

/// Whether most points have a direction that is in `cells`.
bool seen_again(const std::vector<Eigen::Vector3f>& points, const std::vector<bool>& cells) {
  const std::size_t stride = points.size() / kPointsCompared + 1;
  std::size_t compared = 0;
  std::size_t again = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const std::optional<std::size_t> cell = cell_of(points[i]);
    if (!cell) continue;
    ++compared;
    again += cells[*cell] ? 1 : 0;
  }
  return compared > 0 && static_cast<double>(again) > kSeenAgain * static_cast<double>(compared);
}

}  // namespace

PartsOfSweep::PartsOfSweep(double period_s) : period_s_(period_s) {
  if (!(period_s > kShortestS && period_s < kLongestPartS)) parts_ = 1;
}

void PartsOfSweep::add(const Sweep& sweep) {
  if (parts_) return;
  if (added_ == 0) {
    first_.assign(kAzimuths * kElevations, false);
    for (const Eigen::Vector3f& point : sweep.points) {
      if (const std::optional<std::size_t> cell = cell_of(point)) first_[*cell] = true;
    }
  } else if (seen_again(sweep.points, first_)) {
    parts_ = added_;
  } else if (static_cast<double>(added_ + 1) * period_s_ > kLongestTurnS) {
    parts_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kUsualSweepS / period_s_)));
  }
  ++added_;
}

}  // namespace rilo::detail
