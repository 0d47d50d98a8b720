// How well a pose explains the local map.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "map/local_map.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Mean over `points` (sensor frame) of exp(−e²/2σ²), e the distance to the map's plane at the point's place under
/// `T_odom_lidar`, in a voxel of `level` or a coarser one; a point without a plane counts 0. 0 … 1; 0 when there are no
/// points.
double map_score(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                 double sigma_m, std::size_t level = 0);

/// Whether the map shows `points` at `T_odom_lidar` rather than at one of four places a metre beside it: left, right,
/// front and back. What the pose explains and the place does not, in terms of map_score(), must be twice what the place
/// explains and the pose does not, or that be little. A registration finds a pose that fits a map of other places, too;
/// but then the places beside it fit as many other points. True where no point has a plane.
bool stands_out(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                double sigma_m);

}  // namespace rilo
