// Relative error of the KITTI odometry benchmark: t_rel and r_rel.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Relative error over one stretch of the path.
struct KittiSegment {
  std::size_t first = 0;       ///< index of the first pose
  std::size_t last = 0;        ///< index of the first pose at least length_m farther along the true path
  double length_m = 0;         ///< nominal length
  double t_err = 0;            ///< translation error / nominal length (m/m)
  double r_err_rad_per_m = 0;  ///< rotation error / nominal length (rad/m)
};

/// Means over the segments of one nominal length.
struct KittiLengthError {
  double length_m = 0;
  std::size_t count = 0;
  double t_rel_pct = 0;
  double r_rel_deg_100m = 0;
};

/// Relative error of one sequence, or of several pooled ones.
struct KittiError {
  std::vector<KittiSegment> segments;  ///< raw errors, so that pooling over sequences is exact
  bool short_path = false;             ///< path below 150 m: the lengths are eighths of 80 % of the path

  /// Mean over all segments (%, m per 100 m); empty when the sequence holds no segment.
  std::optional<double> t_rel_pct() const;
  /// Mean over all segments (degrees per 100 m); empty when the sequence holds no segment.
  std::optional<double> r_rel_deg_100m() const;
  /// Means per nominal length, ascending; lengths without a segment are skipped.
  std::vector<KittiLengthError> per_length() const;
};

/// Errors of the KITTI odometry development kit (Geiger et al., CVPR 2012; devkit/cpp/evaluate_odometry.cpp).
/// Starts every 10 poses, lengths 100, 200 … 800 m along the true path; a segment ends at the first pose at least that
/// far on (the devkit's: farther, which differs where a path falls on a length exactly); its error is (T_est_first⁻¹
/// T_est_last)⁻¹ (T_truth_first⁻¹ T_truth_last), divided by the nominal length. Paths shorter than 150 m use the
/// lengths k/8 of 80 % of the path (k = 1 … 8) instead, or `lengths_m` when given. The result does not depend on the
/// frame of either trajectory, nor on any alignment.
/// @throws std::invalid_argument as check_trajectories, or when a given length is not positive.
KittiError kitti_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                       const std::vector<double>& lengths_m = {});

/// Averages over several sequences, the two ways the field prints them.
struct KittiBenchmark {
  std::optional<double> pooled_t_rel_pct;  ///< over all segments of all sequences: the devkit's figure
  std::optional<double> pooled_r_rel_deg_100m;
  std::optional<double> sequence_mean_t_rel_pct;  ///< mean of the sequences' means: what most papers print
  std::optional<double> sequence_mean_r_rel_deg_100m;
  std::vector<KittiLengthError> per_length;  ///< pooled
};

/// Sequences without a segment count in neither average.
KittiBenchmark kitti_benchmark(const std::vector<KittiError>& sequences);

}  // namespace rilo
