#pragma once

namespace rilo {

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
  double angle_noise_rad = 0.0003;  ///< σ_a: standard deviation of its direction; 0: normals count as exact
  double scatter_voxel_m = 0.5;     ///< smallest voxel whose points count as a Gaussian where they are no plane; 0: off
};

}  // namespace rilo
