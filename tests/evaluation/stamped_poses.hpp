// Poses that are known by their place, to see which were paired.
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/trajectories.hpp"
#include "rilo/geometry/trajectory.hpp"

namespace rilo::test {

/// Poses whose x is their place in the list.
inline Trajectory stamped(const std::vector<std::int64_t>& stamps_ns) {
  Trajectory trajectory;
  for (const std::int64_t stamp : stamps_ns) {
    trajectory.push_back({stamp, pose(static_cast<double>(trajectory.size()), 0, 0)});
  }
  return trajectory;
}

inline std::vector<double> places(const std::vector<SE3>& poses) {
  std::vector<double> xs;
  for (const SE3& T : poses) xs.push_back(T.translation().x());
  return xs;
}

}  // namespace rilo::test
