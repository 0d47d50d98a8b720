#include "rilo/cloud/thinned_map.hpp"

#include "cloud/map_normals.hpp"
#include "geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr double kNormalRadiusVoxels = 3.0;  // on a surface some 28 points
}

void ThinnedMap::add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
                     const std::vector<float>& intensities) {
  const double inverse = 1.0 / voxel_m_;
  const auto sweep = static_cast<std::uint32_t>(places_.size());
  places_.push_back(T_odom_lidar.translation().cast<float>());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d world = T_odom_lidar * points[i].cast<double>();
    if (!taken_.insert(voxel_key(voxel_of(world, inverse))).second) {
      continue;
    }
    // A column of all points or none: later ones have no place behind a sweep without intensities.
    if (!intensities.empty() && intensities_.size() == points_.size()) {
      intensities_.push_back(intensities[i]);
    }
    points_.push_back(world.cast<float>());
    sweeps_.push_back(sweep);
  }
}

MapCloud ThinnedMap::cloud(bool with_normals) const {
  MapCloud cloud{points_, {}, {}};
  if (intensities_.size() == points_.size()) {
    cloud.intensities = intensities_;
  }
  if (with_normals) {
    std::vector<Eigen::Vector3f> seen_from;
    seen_from.reserve(points_.size());
    for (const std::uint32_t sweep : sweeps_) {
      seen_from.push_back(places_[sweep]);
    }
    cloud.normals = map_normals(points_, seen_from, kNormalRadiusVoxels * voxel_m_);
  }
  return cloud;
}

}  // namespace rilo
