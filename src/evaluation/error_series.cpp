#include "rilo/evaluation/error_series.hpp"

#include "rilo/geometry/degrees.hpp"

namespace rilo {

std::vector<ErrorSample> error_series(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment) {
  const SE3 T_truth_estimate = alignment_of(truth, estimate, alignment);
  const std::vector<double> distances = path_lengths(truth);
  std::vector<ErrorSample> series;
  series.reserve(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const SE3 E = truth[i].inverse() * (T_truth_estimate * estimate[i]);
    series.push_back({distances[i], E.translation().norm(), rotation_angle_rad(E) * kDegPerRad, E.translation()});
  }
  return series;
}

}  // namespace rilo
