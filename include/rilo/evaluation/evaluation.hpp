// All errors of a trajectory against a ground truth.
#pragma once

#include <vector>

#include "rilo/evaluation/kitti_error.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

/// All errors of one trajectory.
struct Evaluation {
  std::size_t poses = 0;
  double path_m = 0;  ///< length of the true path
  KittiError kitti;
  AbsolutePoseError ape;            ///< after Umeyama alignment, the figure of the papers
  AbsolutePoseError ape_unaligned;  ///< first poses made equal, nothing else
  RelativePoseError rpe_frame;
  RelativePoseError rpe_metre;
  double end_error_m = 0;           ///< distance of the last positions when the first poses are made equal
  double end_error_pct = 0;         ///< of the path; 0 for a path of no length
  std::vector<ErrorSample> series;  ///< first poses made equal
};

/// Evaluates `estimate` against `truth`: same length, same times, poses of the same sensor.
/// @throws std::invalid_argument as check_trajectories.
Evaluation evaluate(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

}  // namespace rilo
