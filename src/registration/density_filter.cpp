#include "registration/density_filter.hpp"

#include <algorithm>
#include <cmath>

#include "cloud/fixed_chunks.hpp"

namespace rilo {

std::vector<std::uint32_t> point_densities(const PointGrid& grid, double radius_m) {
  const auto& points = grid.points();
  std::vector<std::uint32_t> densities(points.size());
  for_fixed_chunks<kSmallChunkSize>(points.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      densities[i] = static_cast<std::uint32_t>(grid.count_within(points[i], radius_m));
    }
  });
  return densities;
}

std::uint32_t density_threshold(std::vector<std::uint32_t> densities, double percentile) {
  if (densities.empty() || percentile <= 0.0) {
    return 0;
  }
  const double position = std::ceil(percentile / 100.0 * static_cast<double>(densities.size())) - 1.0;
  const auto rank = std::min(static_cast<std::size_t>(std::max(position, 0.0)), densities.size() - 1);
  std::nth_element(densities.begin(), densities.begin() + static_cast<std::ptrdiff_t>(rank), densities.end());
  return densities[rank];
}

std::vector<Eigen::Vector3f> density_filter(const PointGrid& grid, double radius_m, double percentile) {
  if (percentile <= 0.0) {
    return grid.points();
  }
  const std::vector<std::uint32_t> densities = point_densities(grid, radius_m);
  const std::uint32_t threshold = density_threshold(densities, percentile);
  std::vector<Eigen::Vector3f> kept;
  kept.reserve(densities.size());
  for (std::size_t i = 0; i < densities.size(); ++i) {
    if (densities[i] >= threshold) {
      kept.push_back(grid.points()[i]);
    }
  }
  return kept;
}

}  // namespace rilo
