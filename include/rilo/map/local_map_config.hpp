#pragma once

namespace rilo {

/// Local voxel map.
struct LocalMapConfig {
  double voxel_m = 0.14;       ///< smallest voxel; every level above doubles it
  int levels = 4;              ///< number of voxel sizes
  double scene_voxels = 32.0;  ///< the finest level in use is the one whose voxel is nearest to scene range / this
  double radius_m = 110.0;     ///< voxels farther from the sensor are evicted
  int min_points = 6;          ///< a voxel with fewer points has no plane
  int max_points = 20;         ///< a voxel with that many points is full: old surfaces do not creep with new poses
  double max_planarity = 0.1;  ///< largest smallest-to-middle eigenvalue ratio of a plane
  double min_extent = 0.1;     ///< smallest middle standard deviation of a plane, in voxels
};

}  // namespace rilo
