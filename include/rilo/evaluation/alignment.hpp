// Rigid alignment of an estimated trajectory with the true one.
#pragma once

#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// What is done to the estimate before absolute errors are taken.
enum class Alignment {
  kNone,       ///< nothing: both trajectories are compared as given
  kFirstPose,  ///< the first poses are made equal: errors grow with the drift
  kUmeyama,    ///< least-squares rigid motion, no scale: what papers call APE or ATE
};

/// Rigid motion T_truth_estimate that minimises the squared distances between the positions of `truth` and the moved
/// positions of `estimate` (Umeyama, PAMI 1991, without scale). Where positions leave a rotation open (a straight line,
/// a sensor at rest), the orientations of the poses decide it.
/// @throws std::invalid_argument as check_trajectories.
SE3 align_umeyama(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// T_truth_estimate for the chosen alignment. @throws std::invalid_argument as check_trajectories.
SE3 alignment_of(const std::vector<SE3>& truth, const std::vector<SE3>& estimate, Alignment alignment);

/// `poses`, each multiplied by `T` from the left.
std::vector<SE3> moved(const std::vector<SE3>& poses, const SE3& T);

/// @throws std::invalid_argument unless both have the same length of at least two poses, all of them finite.
void check_trajectories(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// Length of the path up to each pose (m), starting with 0.
std::vector<double> path_lengths(const std::vector<SE3>& poses);

}  // namespace rilo
