// A floor and a wall seen along a drive, for tests of the map's sharpness.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "evaluation/trajectories.hpp"

namespace rilo::test {

using Points = std::vector<Eigen::Vector3f>;

struct Drive {
  std::vector<Points> sweeps;
  std::vector<SE3> poses;
};

// A floor 1.5 m below and a wall 5 m to the left, seen from a sensor that drives along x; `noise_m` is that of the
// distance to them. Places are drawn again for every sweep.
inline Drive floor_and_wall(std::size_t sweeps, std::size_t points, double noise_m, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> across(-1, 1);
  std::normal_distribution<double> noise(0, noise_m);
  Drive drive;
  for (std::size_t i = 0; i < sweeps; ++i) {
    const SE3 T = pose(0.1 * static_cast<double>(i), 0, 0, 0.01 * static_cast<double>(i));
    Points sweep;
    for (std::size_t k = 0; k < points; ++k) {
      const double x = 10 + 2 * across(random);
      const Eigen::Vector3d p = k % 2 == 0 ? Eigen::Vector3d(x, 2 * across(random), -1.5 + noise(random))
                                           : Eigen::Vector3d(x, 5 + noise(random), 2 + 2 * across(random));
      sweep.emplace_back((T.inverse() * p).cast<float>());
    }
    drive.sweeps.push_back(sweep);
    drive.poses.push_back(T);
  }
  return drive;
}

}  // namespace rilo::test
