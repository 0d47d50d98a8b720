#include "rilo/cloud/thinned_map.hpp"

#include "rilo/geometry/voxel_key.hpp"

namespace rilo {

void ThinnedMap::add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar) {
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d world = T_odom_lidar * p.cast<double>();
    if (taken_.insert(voxel_key(voxel_of(world, inverse_))).second) {
      points_.push_back(world.cast<float>());
    }
  }
}

}  // namespace rilo
