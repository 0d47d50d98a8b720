#include "rilo/evaluation/pose_error.hpp"

#include <algorithm>

#include "geometry/degrees.hpp"

namespace rilo {

AbsolutePoseError absolute_pose_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment) {
  AbsolutePoseError error;
  error.alignment = alignment;
  error.T_truth_estimate = alignment_of(truth, estimate, alignment);
  std::vector<double> translations;
  std::vector<double> rotations;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const SE3 T = error.T_truth_estimate * estimate[i];
    translations.push_back((T.translation() - truth[i].translation()).norm());
    rotations.push_back(rotation_angle_rad(truth[i].inverse() * T) * kDegPerRad);
  }
  error.translation_m = summarise(std::move(translations));
  error.rotation_deg = summarise(std::move(rotations));
  return error;
}

namespace {

/// Errors of pairs of poses, collected before they are summed up.
class PairErrors {
 public:
  PairErrors(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) : truth_(truth), estimate_(estimate) {}

  void add(std::size_t first, std::size_t last, double divisor) {
    const SE3 true_motion = truth_[first].inverse() * truth_[last];
    const SE3 E = true_motion.inverse() * (estimate_[first].inverse() * estimate_[last]);
    translations_m_.push_back(E.translation().norm() / divisor);
    rotations_deg_.push_back(rotation_angle_rad(E) * kDegPerRad / divisor);
  }
  RelativePoseError summary() const { return {summarise(translations_m_), summarise(rotations_deg_)}; }

 private:
  const std::vector<SE3>& truth_;
  const std::vector<SE3>& estimate_;
  std::vector<double> translations_m_;
  std::vector<double> rotations_deg_;
};

}  // namespace

RelativePoseError rpe_per_frame(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
  check_trajectories(truth, estimate);
  PairErrors errors(truth, estimate);
  for (std::size_t i = 1; i < truth.size(); ++i) errors.add(i - 1, i, 1.0);
  return errors.summary();
}

RelativePoseError rpe_per_metre(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
  check_trajectories(truth, estimate);
  const std::vector<double> distances = path_lengths(truth);
  PairErrors errors(truth, estimate);
  for (std::size_t first = 0; first < truth.size(); ++first) {
    const auto last = std::lower_bound(distances.begin(), distances.end(), distances[first] + 1.0);
    if (last == distances.end()) break;
    errors.add(first, static_cast<std::size_t>(last - distances.begin()), *last - distances[first]);
  }
  return errors.summary();
}

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
