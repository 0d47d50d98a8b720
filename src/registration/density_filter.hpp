// Density filter of the coarse registration (III-A, eq. 1).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cloud/point_grid.hpp"

namespace rilo {

/// D_m of every point of the grid's cloud: number of points within `radius_m`, itself included (eq. 1).
std::vector<std::uint32_t> point_densities(const PointGrid& grid, double radius_m);

/// Q_α(D): the `percentile` (0 … 100) of the densities, the smallest value with at least that share at or below it. 0
/// when empty.
std::uint32_t density_threshold(std::vector<std::uint32_t> densities, double percentile);

/// Points with D_m >= D_th, in their order. A percentile of 0 keeps all.
std::vector<Eigen::Vector3f> density_filter(const PointGrid& grid, double radius_m, double percentile);

}  // namespace rilo
