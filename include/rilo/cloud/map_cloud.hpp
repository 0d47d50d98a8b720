// Points of a map and what is known about each.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Points in the odometry frame (m). The other columns are empty or as long as `points`.
struct MapCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< unit, on the side the surface was seen from; zero where there is none
  std::vector<float> intensities;        ///< sensor units
};

}  // namespace rilo
