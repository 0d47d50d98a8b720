// Surface covariances from k nearest neighbours (III-A, eq. 2 and 3).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud/point_grid.hpp"

namespace rilo {

/// C_m of every point of the grid's cloud from its `k` nearest neighbours (itself included) within `max_distance_m`
/// (m²). A point with fewer than four neighbours gets the zero matrix: nothing is known of its surface.
std::vector<Eigen::Matrix3f> point_covariances(const PointGrid& grid, int k, double max_distance_m);

}  // namespace rilo
