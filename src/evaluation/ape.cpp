#include "rilo/evaluation/ape.hpp"

#include "rilo/geometry/degrees.hpp"

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

}  // namespace rilo
