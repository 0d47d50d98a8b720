#include "rilo/map/plane_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace rilo {

namespace {
constexpr std::size_t kFirstPlaneSlots = 1U << 12U;
constexpr double kFaceShare = 0.2;         // a face is near within this share of the voxel
constexpr double kLeastVariance = 1e-12;   // m²
constexpr double kLeastReliability = 0.3;  // of a normal: below it the points may as well lie on one cone
constexpr std::size_t kBatch = 16;         // so many accesses to memory are under way together

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
/// regression is right, equal in all directions the fit. 1 when the regression says nothing.
double normal_reliability(const Eigen::Vector3d& normal, const Eigen::Vector3d& regression,
                          const Eigen::Vector3d& ray) {
  const double most = regression.dot(ray);
  const double along = normal.dot(ray);
  const double share = along * along * regression.squaredNorm() / (most * most);
  return std::isfinite(share) ? std::min(share, 1.0) : 1.0;
}
}  // namespace

PlaneGrid::PlaneGrid(double voxel_m, const PlaneCriteria& criteria)
    : voxel_m_(voxel_m), inverse_(1.0 / voxel_m), criteria_(criteria), slots_(kFirstPlaneSlots) {}

Eigen::Vector3d PlaneGrid::centre_of(const Voxel& voxel) const { return centre_of(voxel_of_key(voxel.key, place_)); }

void PlaneGrid::insert(const InsertedPoint& point) {
  add(find_or_add(voxel_key(voxel_of(point.place, inverse_))).voxel, point);
}

void PlaneGrid::insert(const std::vector<InsertedPoint>& points) {
  std::array<std::uint64_t, kBatch> keys{};
  std::array<std::uint32_t, kBatch> ids{};
  for (std::size_t first = 0; first < points.size(); first += kBatch) {
    const std::size_t n = std::min(kBatch, points.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      keys[i] = voxel_key(voxel_of(points[first + i].place, inverse_));
      __builtin_prefetch(&slots_[mix_key(keys[i]) & (slots_.size() - 1)]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Slot& slot = find_or_add(keys[i]);
      ids[i] = slot.full ? kNone : slot.voxel;
      if (!slot.full) {
        __builtin_prefetch(&pool_[slot.voxel]);
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (ids[i] != kNone) {
        add(ids[i], points[first + i]);
      }
    }
  }
}

void PlaneGrid::add(std::uint32_t id, const InsertedPoint& point) {
  Voxel& voxel = pool_[id];
  if (voxel.count >= criteria_.max_points) {
    if (voxel.fit != Fit::kNoPlane) {
      slots_[slot_of(voxel.key)].full = voxel.fit == Fit::kPlane;
      return;
    }
    const std::int32_t kept = voxel.count / 2;
    const float share = static_cast<float>(kept) / static_cast<float>(voxel.count);
    voxel.count = kept;
    voxel.fitted_count = voxel.count;
    voxel.sum *= share;
    voxel.squares *= share;
    voxel.lever_sum *= share;
    voxel.ray_sum *= share;
  }
  const Eigen::Vector3f d = (point.place - centre_of(voxel_of(point.place, inverse_))).cast<float>();
  voxel.sum += d;
  voxel.lever_sum += point.elevation_lever;
  voxel.ray_sum += point.ray;
  voxel.squares[0] += d.x() * d.x();
  voxel.squares[1] += d.x() * d.y();
  voxel.squares[2] += d.x() * d.z();
  voxel.squares[3] += d.y() * d.y();
  voxel.squares[4] += d.y() * d.z();
  voxel.squares[5] += d.z() * d.z();
  ++voxel.count;
  // Refit when the evidence has grown by half: a plane is fitted about log(n) times in its life, not n times.
  if (voxel.count >= criteria_.min_points && 2 * voxel.count >= 3 * voxel.fitted_count) {
    touched_.push_back(id);
    voxel.fitted_count = voxel.count;
  }
}

void PlaneGrid::turn_elevation(double angle_rad, const RigidLever& sensor) {
  for (std::size_t id = 0; id < pool_.size(); ++id) {
    Voxel& voxel = pool_[id];
    if (voxel.count == 0) {
      continue;
    }
    // Every point moves by the mean: what differs between them is of second order.
    const auto n = static_cast<float>(voxel.count);
    const Eigen::Vector3d centroid = centre_of(voxel) + (voxel.sum / n).cast<double>();
    const Eigen::Vector3f own = sensor.at(centroid).cast<float>();
    const Eigen::Vector3f shift = static_cast<float>(angle_rad) * (voxel.lever_sum / n - own);
    const Eigen::Matrix3f moved = voxel.sum * shift.transpose();
    const Eigen::Matrix3f change = moved + moved.transpose() + n * shift * shift.transpose();
    voxel.squares[0] += change(0, 0);
    voxel.squares[1] += change(0, 1);
    voxel.squares[2] += change(0, 2);
    voxel.squares[3] += change(1, 1);
    voxel.squares[4] += change(1, 2);
    voxel.squares[5] += change(2, 2);
    voxel.sum += n * shift;
    planes_[id].mean += shift;
  }
}

void PlaneGrid::refit() {
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::uint32_t id : touched_) {
    // An eviction in between may have freed the place, and an insertion taken it anew.
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
  const double range_m = voxel.ray_sum.cast<double>().norm() / n;
  SymmetricEigen3 surface;
  double lambda = 1.0;
  if (range_m > 0.0) {
    const Eigen::Vector3d ray = voxel.ray_sum.cast<double>() / (n * range_m);
    const Eigen::Vector3d regression = regression_normal(C, ray);
    surface = symmetric_eigen(without_range_noise(C, ray, regression, criteria_.range_noise_m));
    if (criteria_.angle_noise_rad > 0.0) {
      lambda = direction_reliability(C, ray, criteria_.angle_noise_rad * range_m) *
               normal_reliability(surface.vectors.col(0), regression, ray);
    }
  } else {
    surface = symmetric_eigen(C);
  }
  const double smallest = std::max(surface.values[0], 0.0);
  const double middle = surface.values[1];
  const bool reliable = lambda >= kLeastReliability;
  const bool planar = reliable && middle > criteria_.min_extent_m * criteria_.min_extent_m &&
                      smallest < criteria_.max_planarity * middle;
  voxel.fit = planar ? Fit::kPlane : Fit::kNoPlane;
  planes_[id].mean = mean.cast<float>();
  planes_[id].weight = static_cast<float>(lambda * lambda);
  keep_extents(id, C, planar ? surface : symmetric_eigen(C));
  Slot& slot = slots_[slot_of(voxel.key)];
  slot.kind = planar ? Kind::kPlane : (reliable ? Kind::kScatter : Kind::kNone);
  slot.full = slot.full && planar;
}

void PlaneGrid::keep_extents(std::uint32_t id, const Eigen::Matrix3d& covariance, const SymmetricEigen3& eigen) {
  // With the noise: it is what makes the normal uncertain.
  const double smallest = std::max(eigen.vectors.col(0).dot(covariance * eigen.vectors.col(0)), 0.0);
  planes_[id].normal = eigen.vectors.col(0).cast<float>();
  planes_[id].thickness = static_cast<float>(std::sqrt(smallest));
  // Three degrees of freedom went into the plane.
  extents_[id] = {eigen.vectors.col(1).cast<float>(), static_cast<float>(std::max(eigen.values[1], kLeastVariance)),
                  static_cast<float>(std::max(eigen.values[2], kLeastVariance)),
                  static_cast<float>(smallest / std::max(static_cast<double>(pool_[id].count) - 3.0, 1.0))};
}

bool PlaneGrid::find(const Eigen::Vector3d& p, MapPlane& plane) const {
  PlaneSpot spot;
  if (!locate(p, spot)) {
    return false;
  }
  plane = plane_at(spot);
  return true;
}

bool PlaneGrid::locate(const Eigen::Vector3d& p, PlaneSpot& spot) const {
  const VoxelIndex index = index_of(p);
  VoxelIndex behind;
  return look_up(index, spot) == Kind::kPlane ||
         (behind_face(p, index, behind) && look_up(behind, spot) == Kind::kPlane);
}

PlaneGrid::Kind PlaneGrid::look_up(const VoxelIndex& index, PlaneSpot& spot) const {
  const Slot& slot = slots_[slot_of(voxel_key(index))];
  if (slot.voxel == kNone) {
    return Kind::kNone;
  }
  if (slot.kind == Kind::kPlane) {
    __builtin_prefetch(&planes_[slot.voxel]);
  }
  spot = {this, slot.voxel, index, slot.kind == Kind::kScatter};
  return slot.kind;
}

bool PlaneGrid::behind_face(const Eigen::Vector3d& p, const VoxelIndex& index, VoxelIndex& behind) const {
  const Eigen::Vector3d offset = (p - centre_of(index)) * inverse_;  // −½ … ½
  Eigen::Index axis = 0;
  if (offset.cwiseAbs().maxCoeff(&axis) < 0.5 - kFaceShare) {
    return false;
  }
  const int step = offset[axis] > 0.0 ? 1 : -1;
  behind = {index.x + (axis == 0 ? step : 0), index.y + (axis == 1 ? step : 0), index.z + (axis == 2 ? step : 0)};
  return true;
}

MapPlane PlaneGrid::plane_at(const PlaneSpot& spot) const {
  const Plane& plane = planes_[spot.voxel];
  return {centre_of(spot.index) + plane.mean.cast<double>(), plane.normal.cast<double>(), plane.thickness,
          plane.weight};
}

MapScatter PlaneGrid::scatter_at(const PlaneSpot& spot) const {
  const Plane& least = planes_[spot.voxel];
  const Extent& extent = extents_[spot.voxel];
  MapScatter scatter;
  scatter.mean = centre_of(spot.index) + least.mean.cast<double>();
  scatter.axes.col(0) = least.normal.cast<double>();
  scatter.axes.col(1) = extent.middle.cast<double>();
  scatter.axes.col(2) = scatter.axes.col(0).cross(scatter.axes.col(1));
  const auto thickness = static_cast<double>(least.thickness);
  scatter.variances << thickness * thickness, extent.middle_variance, extent.large_variance;
  scatter.bounded = (1.0 - (12.0 * inverse_ * inverse_) * scatter.variances.array()).max(0.0);  // filled: voxel² / 12
  scatter.weight = static_cast<double>(least.weight);
  return scatter;
}

Eigen::Matrix3d PlaneGrid::normal_covariance_at(const PlaneSpot& spot) const {
  // Errors of the slopes of a regression plane.
  const Extent& extent = extents_[spot.voxel];
  const Eigen::Vector3d middle = extent.middle.cast<double>();
  const Eigen::Vector3d large = planes_[spot.voxel].normal.cast<double>().cross(middle);
  return static_cast<double>(extent.error_variance / extent.middle_variance) * middle * middle.transpose() +
         static_cast<double>(extent.error_variance / extent.large_variance) * large * large.transpose();
}

bool PlaneGrid::occupied(const Eigen::Vector3d& p) const {
  return slots_[slot_of(voxel_key(voxel_of(p, inverse_)))].voxel != kNone;
}

PlaneGrid::Slot& PlaneGrid::find_or_add(std::uint64_t key) {
  Slot& slot = slots_[slot_of(key)];
  if (slot.voxel != kNone) {
    return slot;
  }
  std::uint32_t id = static_cast<std::uint32_t>(pool_.size());
  if (free_.empty()) {
    pool_.emplace_back();
    planes_.emplace_back();
    extents_.emplace_back();
  } else {
    id = free_.back();
    free_.pop_back();
  }
  pool_[id].key = key;
  slot = {key, id, Kind::kNone, false};
  if (++used_ * 2 <= slots_.size()) {
    return slot;
  }
  grow();
  return slots_[slot_of(key)];
}

void PlaneGrid::grow() {
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
  for (const Slot& slot : old) {
    if (slot.voxel != kNone) {
      slots_[slot_of(slot.key)] = slot;
    }
  }
}

void PlaneGrid::erase(std::uint32_t voxel) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t hole = slot_of(pool_[voxel].key);
  // Backward shift: later entries of the probe sequence move up, so that no tombstones slow the look-ups down.
  for (std::size_t next = (hole + 1) & mask; slots_[next].voxel != kNone; next = (next + 1) & mask) {
    const std::size_t home = mix_key(slots_[next].key) & mask;
    if (((next - home) & mask) >= ((next - hole) & mask)) {
      slots_[hole] = slots_[next];
      hole = next;
    }
  }
  slots_[hole] = Slot{};
  pool_[voxel] = Voxel{};
  free_.push_back(voxel);
  --used_;
}

void PlaneGrid::evict(const Eigen::Vector3d& centre, double radius_m) {
  place_ = voxel_of(centre, inverse_);
  const double radius2 = radius_m * radius_m;
  const std::size_t slice = pool_.size() / kEvictionRounds + 1;
  for (std::size_t i = 0; i < slice && !pool_.empty(); ++i) {
    eviction_cursor_ = (eviction_cursor_ + 1) % pool_.size();
    const Voxel& voxel = pool_[eviction_cursor_];
    if (voxel.count > 0 && (centre_of(voxel) - centre).squaredNorm() > radius2) {
      erase(static_cast<std::uint32_t>(eviction_cursor_));
    }
  }
}

void PlaneGrid::centroids(std::vector<Eigen::Vector3f>& out) const {
  for (const Voxel& voxel : pool_) {
    if (voxel.count > 0) {
      out.push_back((centre_of(voxel) + voxel.sum.cast<double>() / voxel.count).cast<float>());
    }
  }
}

}  // namespace rilo
