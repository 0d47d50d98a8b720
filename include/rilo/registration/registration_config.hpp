// Configuration of the two registrations.
#pragma once

namespace rilo {

/// Density-filtered distribution-to-distribution registration (III-A).
struct CoarseRegistrationConfig {
  bool enabled = true;  ///< false: ablation A, the prediction is the initial pose
  bool always =
      false;  ///< true: on every sweep as in the paper; false: only when the prediction explains the map badly
  double voxel_m = 1.0;             ///< voxel size of the coarse clouds
  int max_points = 1000;            ///< largest number of points of a coarse cloud
  double density_radius_m = 2.0;    ///< r: neighbours within it count (eq. 1)
  double density_percentile = 5.0;  ///< α: share of the least dense points dropped, percent (eq. Q_α)
  int neighbours = 10;              ///< k of the covariances (eq. 2)
  double sigma = 1.0;               ///< σ of the weight (eq. 6), in units of the Mahalanobis distance
  double damping = 1e-3;            ///< λ of eq. 9, relative to the largest diagonal element
  int max_iterations = 20;
  double max_correspondence_m = 3.0;  ///< pairs farther apart are not valid
  double noise_first_m = 0.5;         ///< standard deviation added to the covariances in the first iteration …
  double noise_last_m = 0.1;          ///< … shrinking to this one
};

/// Point-to-plane registration of the source cloud to the local map (III-D).
struct AdaptiveIcpConfig {
  bool adaptive = true;       ///< false: ablation B, unit weights within a fixed gate instead of weights from σ_th
  double fixed_gate_m = 0.5;  ///< residuals beyond it are no correspondences when adaptive is off
  double gate = 3.0;          ///< residuals beyond gate · σ_th are no correspondences
  int max_iterations = 24;
  int coarse_stride = 4;                ///< every n-th point until it converges, then all points
  double damping = 1e-9;                ///< λ, relative to the largest diagonal element
  double rotation_epsilon_rad = 1e-5;   ///< converged when an update rotates less …
  double translation_epsilon_m = 1e-4;  ///< … and moves less
  bool refine_motion = true;            ///< estimate the velocity during the sweep together with the pose
  double noise_m = 0.02;                ///< least standard deviation of a residual
  double scatter_noise_m = 0.01;        ///< σ of the weight σ² / (σ² + variance) of points that meet no plane
  double independent_share = 0.01;      ///< share of the residuals that count as independent in the information
  double weak_direction = 0.004;  ///< relative eigenvalue at which half of a direction is left to the prior; 0: off
};

}  // namespace rilo
