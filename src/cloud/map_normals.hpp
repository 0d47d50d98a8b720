// Normals of the surfaces in a map.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo {

/// The normal at each point: the direction in which its nearest neighbours (up to 20 within `radius_m`) spread least,
/// on the side of `seen_from`, the place of the sensor (m, as long as `points`). Unit vectors; zero where fewer than
/// five neighbours lie or where they lie along a line. Points must be finite.
std::vector<Eigen::Vector3f> map_normals(const std::vector<Eigen::Vector3f>& points,
                                         const std::vector<Eigen::Vector3f>& seen_from, double radius_m);

}  // namespace rilo
