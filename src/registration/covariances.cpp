#include "registration/covariances.hpp"

#include "cloud/fixed_chunks.hpp"

namespace rilo {

namespace {

constexpr std::size_t kLeastNeighbours = 4;  // fewer are always a plane

Eigen::Matrix3f covariance(const std::vector<Eigen::Vector3f>& points, const std::vector<Neighbour>& neighbours) {
  // Neighbours lie within metres of the first: differences to it are exact in single precision.
  const Eigen::Vector3f& origin = points[neighbours.front().index];
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (const Neighbour& n : neighbours) {
    const Eigen::Vector3f d = points[n.index] - origin;
    mean += d;
    squares += d * d.transpose();
  }
  const float inverse = 1.0F / static_cast<float>(neighbours.size());
  mean *= inverse;
  return squares * inverse - mean * mean.transpose();
}

}  // namespace

std::vector<Eigen::Matrix3f> point_covariances(const PointGrid& grid, int k, double max_distance_m) {
  const auto& points = grid.points();
  std::vector<Eigen::Matrix3f> covariances(points.size(), Eigen::Matrix3f::Zero());
  for_fixed_chunks<kSmallChunkSize>(points.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    std::vector<Neighbour> neighbours;
    for (std::size_t i = first; i < last; ++i) {
      grid.nearest(points[i], static_cast<std::size_t>(k), max_distance_m, neighbours);
      if (neighbours.size() >= kLeastNeighbours) {
        covariances[i] = covariance(points, neighbours);
      }
    }
  });
  return covariances;
}

}  // namespace rilo
