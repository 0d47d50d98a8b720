// Clouds without structure.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace rilo::test {

/// `count` points, even in a cube from −extent_m to extent_m; the same for the same seed.
inline std::vector<Eigen::Vector3f> random_points(std::size_t count, float extent_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> uniform(-extent_m, extent_m);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& p : points) {
    p = Eigen::Vector3f(uniform(rng), uniform(rng), uniform(rng));
  }
  return points;
}

}  // namespace rilo::test
