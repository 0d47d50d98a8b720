#pragma once

namespace rilo {

/// Density-filtered distribution-to-distribution registration (III-A).
struct CoarseRegistrationConfig {
  bool enabled = true;  ///< false: ablation A, the prediction is the initial pose
  bool always =
      false;  ///< true: on every sweep as in the paper; false: only when the prediction explains the map badly
  double voxel_m = 1.0;             ///< voxel of its clouds
  int max_points = 1000;            ///< at most that many points a cloud
  double density_radius_m = 2.0;    ///< r: neighbours within it count (eq. 1)
  double density_percentile = 5.0;  ///< α: share of the least dense points dropped, percent (eq. Q_α)
  int neighbours = 10;              ///< k of the covariances (eq. 2)
  double sigma = 1.0;               ///< σ of the weight (eq. 6), in units of the Mahalanobis distance
  double damping = 1e-3;            ///< λ of eq. 9, relative to the largest diagonal element
  int max_iterations = 20;
  double max_correspondence_m = 3.0;  ///< farther pairs are not valid
  double noise_first_m = 0.5;         ///< standard deviation added to the covariances in the first iteration …
  double noise_last_m = 0.1;          ///< … shrinking to this one
};

}  // namespace rilo
