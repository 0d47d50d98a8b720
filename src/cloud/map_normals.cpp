#include "cloud/map_normals.hpp"

#include <cstddef>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_grid.hpp"
#include "geometry/symmetric_eigen.hpp"

namespace rilo {

namespace {

constexpr std::size_t kNeighbours = 20;     // the plane of a map point: usual, no pose depends on it
constexpr std::size_t kLeastForNormal = 5;  // fewer points are a plane by chance
constexpr double kLeastSpread = 0.01;       // middle to largest eigenvalue: below, the points are a line

Eigen::Vector3f normal_of(const PointGrid& grid, const std::vector<Neighbour>& around,
                          const Eigen::Vector3f& to_sensor) {
  if (around.size() < kLeastForNormal) {
    return Eigen::Vector3f::Zero();
  }
  // Relative to the point itself, the nearest of all: far from the origin the squares would cost digits.
  const Eigen::Vector3f& origin = grid.points()[around.front().index];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Neighbour& neighbour : around) {
    const Eigen::Vector3d d = (grid.points()[neighbour.index] - origin).cast<double>();
    sum += d;
    squares += d * d.transpose();
  }
  const auto n = static_cast<double>(around.size());
  const SymmetricEigen3 eigen = symmetric_eigen(squares / n - (sum / n) * (sum / n).transpose());
  if (eigen.values[1] <= kLeastSpread * eigen.values[2]) {
    return Eigen::Vector3f::Zero();
  }
  const Eigen::Vector3f normal = eigen.vectors.col(0).cast<float>();
  return normal.dot(to_sensor) < 0.0F ? Eigen::Vector3f(-normal) : normal;
}

}  // namespace

std::vector<Eigen::Vector3f> map_normals(const std::vector<Eigen::Vector3f>& points,
                                         const std::vector<Eigen::Vector3f>& seen_from, double radius_m) {
  PointGrid grid(radius_m);
  grid.build(points);
  std::vector<Eigen::Vector3f> normals(points.size());
  for_fixed_chunks(points.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<Neighbour> around;
    for (std::size_t i = begin; i < end; ++i) {
      grid.nearest(points[i], kNeighbours, radius_m, around);
      normals[i] = normal_of(grid, around, seen_from[i] - points[i]);
    }
  });
  return normals;
}

}  // namespace rilo
