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
  double map_voxel_ratio = 0.6;  ///< voxel size of the map cloud relative to that of the source cloud
};

}  // namespace rilo
