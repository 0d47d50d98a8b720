#pragma once

namespace rilo {

/// Local voxel map.
struct LocalMapConfig {
  double voxel_m = 0.5;
  double radius_m = 120.0;   ///< voxels farther from the sensor are evicted
};

}  // namespace rilo
