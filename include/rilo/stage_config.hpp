// Configuration of the stages below the odometry: cloud, registration, map, calibration. Plain values, known to all of
// them.
#pragma once

namespace rilo {

/// Range crop, downsampling and motion compensation.
struct PreprocessConfig {
  double min_range_m = 0.5;      ///< nearer points are dropped (the vehicle itself)
  double max_range_m = 100.0;    ///< farther points are dropped
  bool deskew = true;            ///< use per-point times when the sweep has them
  int source_points = 20000;     ///< target size of the source cloud S: its voxel adapts to scene and sensor
  double min_voxel_m = 0.1;      ///< smallest voxel of the source cloud
  double max_voxel_m = 1.0;      ///< largest voxel of the source cloud
  double map_voxel_ratio = 0.8;  ///< voxel size of the map cloud relative to that of the source cloud
  double most_isolated = 0.2;    ///< share of isolated returns: with more of them they are flakes, and are dropped
};

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
  int coarse_stride = 4;          ///< every n-th point until it converges, then all points
  double damping = 1e-9;          ///< λ, relative to the largest diagonal element
  double epsilon = 0.1;           ///< converged when an update is smaller, in standard deviations of pose and velocity
  bool refine_motion = true;      ///< estimate the velocity during the sweep together with the pose
  double noise_m = 0.02;          ///< least standard deviation of a residual
  double scatter_noise_m = 0.05;  ///< σ of the weight σ² / (σ² + variance) of points that meet no plane
  double independent_share = 0.01;  ///< share of the residuals that count as independent in the information
  double weak_direction = 0.003;    ///< relative eigenvalue at which half of a direction is left to the prior; 0: off
};

/// Local voxel map.
struct LocalMapConfig {
  double voxel_m = 0.14;            ///< smallest voxel; every level above doubles it
  int levels = 6;                   ///< number of voxel sizes
  double scene_voxels = 32.0;       ///< the finest level in use is the one whose voxel is nearest to scene range / this
  double radius_m = 110.0;          ///< voxels farther from the sensor are evicted
  int min_points = 6;               ///< a voxel with fewer points has no plane
  int max_points = 20;              ///< points of a full smallest voxel; each level above takes half as many more
  double max_planarity = 0.1;       ///< largest smallest-to-middle eigenvalue ratio of a plane
  double min_extent = 0.1;          ///< smallest middle standard deviation of a plane, in voxels
  double range_noise_m = 0.02;      ///< σ_r: standard deviation of a point along its ray
  double angle_noise_rad = 0.0005;  ///< σ_a: standard deviation of its direction; 0: normals count as exact
  double scatter_voxel_m = 0.5;     ///< smallest voxel whose points count as a Gaussian where they are no plane; 0: off
};

/// Constant error of the sensor's elevation angles, estimated from the sweeps alone.
struct ElevationOffsetConfig {
  bool enabled = true;        ///< estimate it, and correct it once it is significant
  double initial_deg = 0.0;   ///< known offset: added from the first sweep on
  double significance = 2.3;  ///< standard deviations from 0 or initial_deg that are significant
};

/// Errors of the angles of single beams against their neighbours, estimated from the sweeps alone.
struct BeamCalibrationConfig {
  bool enabled = true;  ///< estimate and correct them
  double gain = 0.015;  ///< update gain per sweep
};

}  // namespace rilo
