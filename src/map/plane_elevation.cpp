// How the planes of a grid move with the sensor's elevation offset.
#include <algorithm>

#include "cloud/fixed_chunks.hpp"
#include "map/plane_grid.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

namespace {
/// Turn about the sensor of what it sees at the end of `ray` and what moves by `shift`.
Eigen::Vector3f turn_by(const Eigen::Vector3f& shift, const Eigen::Vector3f& ray) {
  constexpr float kShortestM = 0.1F;
  return ray.cross(shift) / std::max(ray.squaredNorm(), kShortestM * kShortestM);
}
}  // namespace

void PlaneGrid::Voxel::move(const Eigen::Vector3f& shift, const Eigen::Matrix3f& R) {
  const auto n = static_cast<float>(count);
  Eigen::Matrix3f S;
  S << squares[0], squares[1], squares[2], squares[1], squares[3], squares[4], squares[2], squares[4], squares[5];
  const Eigen::Vector3f mean = sum / n;
  const Eigen::Vector3f moved = mean + shift;
  S = (R * (S - n * mean * mean.transpose()) * R.transpose() + n * moved * moved.transpose()).eval();
  squares << S(0, 0), S(0, 1), S(0, 2), S(1, 1), S(1, 2), S(2, 2);
  sum = n * moved;
}

PlaneGrid::Centroid PlaneGrid::centroid_of(const Voxel& voxel, const PoseDerivative& sensor) const {
  const auto n = static_cast<float>(voxel.count);
  const Eigen::Vector3d place = centre_of(voxel) + (voxel.sum / n).cast<double>();
  return {place, voxel.elevation_jacobian_sum / n - sensor.at(place).cast<float>(), voxel.ray_sum / n};
}

Eigen::Vector3d PlaneGrid::elevation_jacobian_at(const PlaneSpot& spot, const Eigen::Vector3d& p,
                                                 const PoseDerivative& sensor) const {
  const Centroid centroid = centroid_of(pool_[spot.voxel], sensor);
  const Eigen::Vector3f turn = turn_by(centroid.by_elevation, centroid.ray);
  return (centroid.by_elevation + turn.cross((p - centroid.place).cast<float>())).cast<double>();
}

void PlaneGrid::shift_elevation(double angle_rad, const PoseDerivative& sensor) {
  for_fixed_chunks(pool_.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t id = first; id < last; ++id) {
      Voxel& voxel = pool_[id];
      if (voxel.count == 0) {
        continue;
      }
      // The points of a voxel move by the mean and turn about it, as they do about the sensor.
      const Centroid centroid = centroid_of(voxel, sensor);
      const Eigen::Vector3f shift = static_cast<float>(angle_rad) * centroid.by_elevation;
      const Eigen::Matrix3f R = so3_exp(turn_by(shift, centroid.ray).cast<double>()).cast<float>();
      voxel.move(shift, R);
      planes_[id].mean += shift;
      planes_[id].normal = R * planes_[id].normal;
      extents_[id].middle = R * extents_[id].middle;
    }
  });
}

}  // namespace rilo
