// Uniform B-splines of degree 5: four continuous derivatives, so that everything derived from the path (attitude from
// curvature and acceleration) is still C2.
#pragma once

#include <array>
#include <cstddef>

namespace rilo::simulation {

/// Value (`derivative` 0) or derivative (1 … 5) per control spacing, `x` in [0, 1) past the third of six control
/// values.
template <typename Value>
Value quintic_spline(std::array<Value, 6> control, std::size_t derivative, double x) {
  const std::size_t degree = 5 - derivative;
  // A derivative is the spline of lower degree over the differences.
  for (std::size_t k = 0; k < derivative; ++k) {
    for (std::size_t i = 0; i + 1 + k < control.size(); ++i) control[i] = control[i + 1] - control[i];
  }
  std::array<double, 6> weight{1.0};
  for (std::size_t j = 1; j <= degree; ++j) {
    double saved = 0.0;
    for (std::size_t r = 0; r < j; ++r) {
      const double share = weight[r] / static_cast<double>(j);
      weight[r] = saved + (static_cast<double>(r + 1) - x) * share;
      saved = (x + static_cast<double>(j - r - 1)) * share;
    }
    weight[j] = saved;
  }
  Value sum = weight[0] * control[0];
  for (std::size_t i = 1; i <= degree; ++i) sum += weight[i] * control[i];
  return sum;
}

}  // namespace rilo::simulation
