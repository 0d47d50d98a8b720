#pragma once

namespace rilo {

/// Range crop, downsampling and motion compensation.
struct PreprocessConfig {
  double min_range_m = 0.5;          ///< nearer points are dropped (the vehicle itself)
  double max_range_m = 100.0;        ///< farther points are dropped
  bool deskew = true;                ///< use per-point times when the sweep has them
  double map_voxel_m = 0.25;         ///< voxel of the cloud that goes into the map
  double source_voxel_m = 0.75;      ///< voxel of the source cloud S
};

}  // namespace rilo
