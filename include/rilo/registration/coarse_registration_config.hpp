#pragma once

namespace rilo {

/// Density-filtered distribution-to-distribution registration (III-A).
struct CoarseRegistrationConfig {
  bool enabled = true;
  double density_radius_m = 1.0;        ///< r: neighbours within it count (eq. 1)
  double density_percentile = 5.0;      ///< α: share of the least dense points dropped, percent
  int neighbours = 10;                  ///< k of the covariances (eq. 2)
  double sigma = 1.0;                   ///< σ of the weight (eq. 6), in units of the Mahalanobis distance
  double damping = 1e-4;                ///< λ of eq. 9, relative to the largest diagonal element
  int max_iterations = 15;
  double max_correspondence_m = 3.0;
};

}  // namespace rilo
