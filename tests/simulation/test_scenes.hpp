// Small scenes with exact geometry, for tests: clouds whose surfaces can be written down.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// How a test scene is sampled. Points lie on a jittered lattice of `spacing_m` on each surface, displaced along the
/// surface's normal by Gaussian noise; the scene is in the frame of the world and is returned in the sensor's.
struct SceneSampling {
  double spacing_m = 0.2;                ///< m, > 0
  double noise_m = 0;                    ///< m, >= 0, standard deviation along the normal
  std::uint64_t seed = 1;                ///< other seed, other samples of the same surfaces
  SE3 T_world_sensor = SE3::Identity();  ///< the cloud is T_world_sensor.inverse() * points in the world
};

/// The six inner faces of the box |x| <= size.x / 2, |y| <= size.y / 2, |z| <= size.z / 2 (m).
std::vector<Eigen::Vector3f> make_box_room(const Eigen::Vector3d& size_m, const SceneSampling& sampling = {});

/// Floor z = -1, and walls y = ±width / 2 up to z = height - 1, for |x| <= length / 2 (m): nothing holds x.
std::vector<Eigen::Vector3f> make_corridor(double length_m, double width_m, double height_m,
                                           const SceneSampling& sampling = {});

/// The square |x|, |y| <= side / 2 of the plane z = -1 (m): only z, roll and pitch can be seen.
std::vector<Eigen::Vector3f> make_ground_plane(double side_m, const SceneSampling& sampling = {});

/// Walls y = ±width / 2, |z| <= height / 2, for |x| <= length / 2 (m): neither x nor z can be seen.
std::vector<Eigen::Vector3f> make_two_walls(double length_m, double width_m, double height_m,
                                            const SceneSampling& sampling = {});

}  // namespace rilo
