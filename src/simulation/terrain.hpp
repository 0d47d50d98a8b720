// The rolling ground below streets and houses.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace rilo::simulation {

/// Smooth height field: a sum of waves, infinitely differentiable, so that what drives on it moves smoothly.
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed);

  /// Height (m) at `p` (m).
  double height(const Eigen::Vector2d& p) const;

 private:
  struct Wave {
    Eigen::Vector2d wave_number;  // rad/m
    double phase = 0;
    double amplitude_m = 0;
  };
  std::array<Wave, 5> waves_;
};

}  // namespace rilo::simulation
