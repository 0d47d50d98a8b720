// Per-point times from the azimuth of the points.
#include <cmath>
#include <numbers>

#include "rilo/io/point_times.hpp"

namespace rilo {

std::vector<float> azimuth_times(const std::vector<Eigen::Vector3f>& points, double period_s, SpinDirection direction) {
  const double per_radian = (direction == SpinDirection::kClockwise ? -period_s : period_s) / (2 * std::numbers::pi);
  std::vector<float> times(points.size(), 0.0F);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double azimuth = std::atan2(static_cast<double>(points[i].y()), static_cast<double>(points[i].x()));
    if (std::isfinite(azimuth)) times[i] = static_cast<float>(azimuth * per_radian);
  }
  return times;
}

}  // namespace rilo
