// The map of a whole run, collected while it runs.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rilo/cloud/thinned_map.hpp"
#include "rilo/session/session_observer.hpp"

namespace rilo {

/// Collects the points of all sweeps with a pose that can be trusted (belongs_in_map), the first one of every voxel.
class MapObserver final : public SessionObserver {
 public:
  /// `voxel_m`: edge of the voxels, m, positive.
  explicit MapObserver(double voxel_m) : voxel_m_(voxel_m), map_(voxel_m) {}

  void on_registered(const RegisteredSweep& sweep) override;
  void on_restart(const Restart& restart) override;
  void on_end(const Odometry& odometry) override;

  /// After the run, odometry frame (m). When no sweep belongs in it: the local map, without normals and intensities.
  /// Intensities are there when SessionOptions::keep_intensities.
  MapCloud cloud(bool with_normals) const;

 private:
  double voxel_m_;
  ThinnedMap map_;
  std::vector<Eigen::Vector3f> local_;
};

}  // namespace rilo
