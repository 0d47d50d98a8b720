// Cars as a few boxes.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/counter_random.hpp"
#include "simulation/solid.hpp"

namespace rilo::simulation {

/// A car in its own frame: x forward, z = 0 on the road, origin below its middle.
struct CarBody {
  std::vector<Solid> parts;
  double radius_m = 0;  ///< of the circle around it, seen from above
};

/// A saloon, an estate or a van, of a size and colour of its own.
CarBody draw_car(RandomStream& random);

/// The parts of the car standing at `position` with its front towards `yaw_rad`.
void place_car(const CarBody& body, const Eigen::Vector3d& position, double yaw_rad, std::vector<Solid>& solids);

}  // namespace rilo::simulation
