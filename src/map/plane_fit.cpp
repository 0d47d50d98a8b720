// How the plane of a voxel is fitted, and how reliable its normal is: see PlaneGrid.
#include <algorithm>
#include <cmath>

#include "map/plane_grid.hpp"

namespace rilo {

namespace {
constexpr double kLeastReliability = 0.3;  // of a normal: below it the points may as well lie on one cone

/// det(C) C⁻¹ r of a covariance and a unit ray: along the normal of the plane from the regression of the range on the
/// directions, without bias when all noise is along the ray, as that of the range and of a rough surface seen at a
/// small angle is.
Eigen::Vector3d regression_normal(const Eigen::Matrix3d& C, const Eigen::Vector3d& ray) {
  return C.col(1).cross(C.col(2)) * ray.x() + C.col(2).cross(C.col(0)) * ray.y() + C.col(0).cross(C.col(1)) * ray.z();
}

/// The covariance `C` (m²) without the noise of the points along the unit `ray`: the known variance, or, where it is
/// less, what the regression of the range on the directions leaves unexplained, 1 / (rᵀ C⁻¹ r).
Eigen::Matrix3d without_range_noise(const Eigen::Matrix3d& C, const Eigen::Vector3d& ray,
                                    const Eigen::Vector3d& regression, double range_noise_m) {
  const double adjugate_along = ray.dot(regression);
  const double determinant = C.col(0).dot(C.col(1).cross(C.col(2)));
  if (!(adjugate_along > 0.0) || !(determinant > 0.0)) {
    return C;
  }
  const double noise = std::min(range_noise_m * range_noise_m, determinant / adjugate_along);
  return C - noise * ray * ray.transpose();
}

/// Share of the spread of directions across the unit `ray` (m²) that is not noise of theirs.
double direction_reliability(const Eigen::Matrix3d& C, const Eigen::Vector3d& ray, double noise_m) {
  // Covariance across the ray, in two directions u, v; its smaller eigenvalue.
  const Eigen::Vector3d u = ray.unitOrthogonal();
  const Eigen::Vector3d v = ray.cross(u);
  const double uu = u.dot(C * u);
  const double vv = v.dot(C * v);
  const double uv = u.dot(C * v);
  const double half = 0.5 * (uu - vv);
  const double spread = std::max(0.0, 0.5 * (uu + vv) - std::sqrt(half * half + uv * uv));
  return spread / (spread + noise_m * noise_m);
}

/// (n·r)² over that of the regression normal: the squared correlation of range and directions at small angles, 1 where
/// the plane is seen from the front. Between the two lies the plane, depending on where the noise is: along the ray the
/// regression is right, equal in all directions the fit. 1 when the regression is singular.
double normal_reliability(const Eigen::Vector3d& normal, const Eigen::Vector3d& regression,
                          const Eigen::Vector3d& ray) {
  const double most = regression.dot(ray);
  const double along = normal.dot(ray);
  const double share = along * along * regression.squaredNorm() / (most * most);
  return std::isfinite(share) ? std::min(share, 1.0) : 1.0;
}
}  // namespace

void PlaneGrid::refit() {
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::uint32_t id : touched_) {
    // An eviction in between may have freed the place, and an insertion reused it.
    if (pool_[id].count >= criteria_.min_points) {
      fit(id);
    }
  }
  touched_.clear();
}

void PlaneGrid::fit(std::uint32_t id) {
  Voxel& voxel = pool_[id];
  voxel.fitted_count = voxel.count;
  const double n = voxel.count;
  const Eigen::Vector3d mean = voxel.sum.cast<double>() / n;
  Eigen::Matrix3d C;
  const Eigen::Matrix<double, 6, 1> s = voxel.squares.cast<double>() / n;
  C << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  C -= mean * mean.transpose();
  const Kind kind = keep_surface(id, C, voxel.ray_sum.cast<double>() / n);
  planes_[id].mean = mean.cast<float>();
  voxel.fit = kind == Kind::kPlane ? Fit::kPlane : Fit::kNoPlane;
  Slot& slot = slot_at(slot_of(voxel.key));
  slot.kind = kind;
  slot.full = slot.full && kind == Kind::kPlane;
}

PlaneGrid::Kind PlaneGrid::keep_surface(std::uint32_t id, const Eigen::Matrix3d& C, const Eigen::Vector3d& mean_ray) {
  const double range_m = mean_ray.norm();
  SymmetricEigen3 surface;
  double lambda = 1.0;
  if (range_m > 0.0) {
    const Eigen::Vector3d ray = mean_ray / range_m;
    const bool noisy = criteria_.angle_noise_rad > 0.0;
    if (noisy) {
      lambda = direction_reliability(C, ray, criteria_.angle_noise_rad * range_m);
      if (lambda < kLeastReliability) {
        return Kind::kNone;
      }
    }
    const Eigen::Vector3d regression = regression_normal(C, ray);
    surface = symmetric_eigen(without_range_noise(C, ray, regression, criteria_.range_noise_m));
    if (noisy) {
      lambda *= normal_reliability(surface.vectors.col(0), regression, ray);
    }
  } else {
    surface = symmetric_eigen(C);
  }
  if (lambda < kLeastReliability) {
    return Kind::kNone;
  }
  const double smallest = std::max(surface.values[0], 0.0);
  const double middle = surface.values[1];
  const bool planar =
      middle > criteria_.min_extent_m * criteria_.min_extent_m && smallest < criteria_.max_planarity * middle;
  if (!planar && !criteria_.keep_scatter) {
    return Kind::kNone;
  }
  planes_[id].weight = static_cast<float>(lambda * lambda);
  keep_extents(id, C, planar ? surface : symmetric_eigen(C));
  return planar ? Kind::kPlane : Kind::kScatter;
}

void PlaneGrid::keep_extents(std::uint32_t id, const Eigen::Matrix3d& covariance, const SymmetricEigen3& eigen) {
  // The thickness is that of the points, their noise included.
  const double smallest = std::max(eigen.vectors.col(0).dot(covariance * eigen.vectors.col(0)), 0.0);
  planes_[id].normal = eigen.vectors.col(0).cast<float>();
  planes_[id].thickness = static_cast<float>(std::sqrt(smallest));
  extents_[id] = {eigen.vectors.col(1).cast<float>(), static_cast<float>(std::max(eigen.values[1], 0.0)),
                  static_cast<float>(std::max(eigen.values[2], 0.0))};
}

}  // namespace rilo
