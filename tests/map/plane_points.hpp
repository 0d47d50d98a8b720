// Planes to fill a grid with.
#pragma once

#include <random>

#include "map/plane_grid.hpp"

namespace rilo::test {

inline constexpr PlaneCriteria kCriteria{6, 100, 0.1, 0.05};

/// Points scattered over the square of half a metre around `centre`, `noise_m` off the plane with this normal.
inline void insert_plane(PlaneGrid& grid, const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, int count,
                         double noise_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> side(-0.25, 0.25);
  std::normal_distribution<double> noise(0.0, 1.0);
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  for (int i = 0; i < count; ++i) {
    grid.insert(centre + side(rng) * u + side(rng) * v + noise_m * noise(rng) * normal);
  }
}

}  // namespace rilo::test
