// A search over poses by map score.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "map/local_map.hpp"
#include "registration/deadline.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Grid of poses around a centre: yaw about the sensor's own z axis, then shifts along its x and y axes.
struct PoseGrid {
  double max_shift_m = 0;
  double shift_step_m = 0;
  double max_yaw_rad = 0;
  double yaw_step_rad = 0;
};

/// The `keep` best poses of the grid around `centre` by map_score(), best first, no two of them closer than two steps
/// to each other. Looks at every third node along each axis first, with a wider sigma, then between the best of them.
/// After the deadline no further pose is scored; the nearest ones come first.
std::vector<SE3> search_poses(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& centre,
                              const PoseGrid& grid, double sigma_m, std::size_t keep, const Deadline& deadline = {});

}  // namespace rilo
