#include "results/view_recording.hpp"

#include <limits>
#include <utility>

namespace rilo {

namespace {

constexpr double kNearM = 30.0;  // of a point of the map
constexpr double kPoseStepM = 2.0;

}  // namespace

std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results) {
  std::vector<std::pair<Eigen::Vector3f, std::uint32_t>> places;  // every few metres
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Eigen::Vector3f place = results[i].T_odom_lidar.translation().cast<float>();
    if (!places.empty() && (place - places.back().first).norm() < static_cast<float>(kPoseStepM)) continue;
    places.emplace_back(place, static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> seen;
  seen.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    float nearest = std::numeric_limits<float>::max();
    std::uint32_t sweep = 0;
    for (const auto& [place, number] : places) {
      const float distance = (place - point).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        sweep = number;
      }
      if (distance < static_cast<float>(kNearM * kNearM)) break;
    }
    seen.push_back(sweep);
  }
  return seen;
}

}  // namespace rilo
