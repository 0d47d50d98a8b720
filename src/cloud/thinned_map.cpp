#include "rilo/cloud/thinned_map.hpp"

#include <stdexcept>
#include <string>

#include "cloud/map_normals.hpp"
#include "geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr double kNormalRadiusVoxels = 3.0;  // on a surface some 28 points
constexpr unsigned int kBlockBits = 4;       // 16 voxels along each edge

unsigned int within_block(int index) { return static_cast<unsigned int>(index) & ((1U << kBlockBits) - 1U); }
}  // namespace

ThinnedMap::ThinnedMap(double voxel_m) : voxel_m_(voxel_m) {
  if (!(voxel_m >= kLeastVoxelM && voxel_m <= kMostVoxelM)) {
    throw std::invalid_argument("voxel_m is " + std::to_string(voxel_m) + "; it must be from " +
                                std::to_string(kLeastVoxelM) + " to " + std::to_string(kMostVoxelM));
  }
}

/// False where its voxel has a point already.
bool ThinnedMap::take(const Eigen::Vector3d& point, double inverse_voxel) {
  const VoxelIndex voxel = voxel_of(point, inverse_voxel);
  Block& block = taken_[voxel_key({voxel.x >> kBlockBits, voxel.y >> kBlockBits, voxel.z >> kBlockBits})];
  const std::size_t bit =
      within_block(voxel.x) | within_block(voxel.y) << kBlockBits | within_block(voxel.z) << 2 * kBlockBits;
  const bool is_new = !block.test(bit);
  block.set(bit);
  return is_new;
}

void ThinnedMap::add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
                     const std::vector<float>& intensities) {
  if (!intensities.empty() && intensities.size() != points.size()) {
    throw std::invalid_argument("intensities: " + std::to_string(intensities.size()) + " values for " +
                                std::to_string(points.size()) + " points");
  }
  const double inverse_voxel = 1.0 / voxel_m_;
  const auto sweep = static_cast<std::uint32_t>(places_.size());
  places_.push_back(T_odom_lidar.translation().cast<float>());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d world = T_odom_lidar * points[i].cast<double>();
    if (!take(world, inverse_voxel)) {
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
  MapCloud cloud{points(), {}, {}};
  if (intensities_.size() == points_.size()) {
    cloud.intensities.assign(intensities_.begin(), intensities_.end());
  }
  if (with_normals) {
    std::vector<Eigen::Vector3f> seen_from;
    seen_from.reserve(points_.size());
    for (const std::uint32_t sweep : sweeps_) {
      seen_from.push_back(places_[sweep]);
    }
    cloud.normals = map_normals(cloud.points, seen_from, kNormalRadiusVoxels * voxel_m_);
  }
  return cloud;
}

}  // namespace rilo
