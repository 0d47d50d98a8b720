#include "rilo/map/plane_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rilo/geometry/symmetric_eigen.hpp"

namespace rilo {

namespace {
constexpr std::size_t kFirstPlaneSlots = 1U << 12U;
constexpr double kFaceShare = 0.2;        // a face is near within this share of the voxel
constexpr double kLeastVariance = 1e-12;  // m²
constexpr std::size_t kBatch = 16;        // so many accesses to memory are under way together
}  // namespace

PlaneGrid::PlaneGrid(double voxel_m, const PlaneCriteria& criteria)
    : voxel_m_(voxel_m), inverse_(1.0 / voxel_m), criteria_(criteria), slots_(kFirstPlaneSlots) {}

Eigen::Vector3d PlaneGrid::centre_of(const VoxelIndex& index) const {
  return voxel_m_ * Eigen::Vector3d(index.x + 0.5, index.y + 0.5, index.z + 0.5);
}

void PlaneGrid::insert(const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever) {
  add(find_or_add(voxel_key(voxel_of(p, inverse_))), p, elevation_lever);
}

void PlaneGrid::insert(const std::vector<Eigen::Vector3d>& points,
                       const std::vector<Eigen::Vector3f>& elevation_levers) {
  std::array<std::uint64_t, kBatch> keys{};
  std::array<std::uint32_t, kBatch> ids{};
  for (std::size_t first = 0; first < points.size(); first += kBatch) {
    const std::size_t n = std::min(kBatch, points.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      keys[i] = voxel_key(voxel_of(points[first + i], inverse_));
      __builtin_prefetch(&slots_[mix_key(keys[i]) & (slots_.size() - 1)]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      ids[i] = find_or_add(keys[i]);
      __builtin_prefetch(&pool_[ids[i]]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      add(ids[i], points[first + i], elevation_levers[first + i]);
    }
  }
}

void PlaneGrid::add(std::uint32_t id, const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever) {
  Voxel& voxel = pool_[id];
  if (voxel.count >= criteria_.max_points) {
    return;
  }
  const Eigen::Vector3f d = (p - centre_of(voxel_of_key(voxel.key))).cast<float>();
  voxel.sum += d;
  voxel.lever_sum += elevation_lever;
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
    const Eigen::Vector3d centroid = centre_of(voxel_of_key(voxel.key)) + (voxel.sum / n).cast<double>();
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
  const SymmetricEigen3 eigen = symmetric_eigen(C);
  const double smallest = std::max(eigen.values[0], 0.0);
  const double middle = eigen.values[1];
  const double extent = criteria_.min_extent_m;
  planes_[id] = {mean.cast<float>(), eigen.vectors.col(0).cast<float>(), static_cast<float>(std::sqrt(smallest))};
  // Errors of the slopes of a regression plane; three degrees of freedom went into it.
  const double per_point = smallest / std::max(n - 3.0, 1.0);
  tilts_[id] = {eigen.vectors.col(1).cast<float>(), static_cast<float>(per_point / std::max(middle, kLeastVariance)),
                static_cast<float>(per_point / std::max(eigen.values[2], kLeastVariance))};
  const bool planar = middle > extent * extent && smallest < criteria_.max_planarity * middle;
  slots_[slot_of(voxel.key)].planar = planar ? 1U : 0U;
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
  const VoxelIndex index = voxel_of(p, inverse_);
  if (plane_in(index, spot)) {
    return true;
  }
  const Eigen::Vector3d offset = (p - centre_of(index)) * inverse_;  // −½ … ½
  Eigen::Index axis = 0;
  if (offset.cwiseAbs().maxCoeff(&axis) < 0.5 - kFaceShare) {
    return false;
  }
  const int step = offset[axis] > 0.0 ? 1 : -1;
  const VoxelIndex behind{index.x + (axis == 0 ? step : 0), index.y + (axis == 1 ? step : 0),
                          index.z + (axis == 2 ? step : 0)};
  return plane_in(behind, spot);
}

MapPlane PlaneGrid::plane_at(const PlaneSpot& spot) const {
  const Plane& plane = planes_[spot.voxel];
  return {centre_of(spot.index) + plane.mean.cast<double>(), plane.normal.cast<double>(), plane.thickness};
}

Eigen::Matrix3d PlaneGrid::normal_covariance_at(const PlaneSpot& spot) const {
  const Tilt& tilt = tilts_[spot.voxel];
  const Eigen::Vector3d middle = tilt.middle.cast<double>();
  const Eigen::Vector3d large = planes_[spot.voxel].normal.cast<double>().cross(middle);
  return static_cast<double>(tilt.middle_variance) * middle * middle.transpose() +
         static_cast<double>(tilt.large_variance) * large * large.transpose();
}

bool PlaneGrid::occupied(const Eigen::Vector3d& p) const {
  return slots_[slot_of(voxel_key(voxel_of(p, inverse_)))].voxel != kNone;
}

bool PlaneGrid::plane_in(const VoxelIndex& index, PlaneSpot& spot) const {
  const Slot& slot = slots_[slot_of(voxel_key(index))];
  if (slot.voxel == kNone || slot.planar == 0) {
    return false;
  }
  __builtin_prefetch(&planes_[slot.voxel]);
  spot = {this, slot.voxel, index};
  return true;
}

/// The slot that holds `key`, or the free one that ends its probe sequence.
std::size_t PlaneGrid::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = mix_key(key) & mask;
  while (slots_[slot].voxel != kNone && slots_[slot].key != key) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

std::uint32_t PlaneGrid::find_or_add(std::uint64_t key) {
  Slot& slot = slots_[slot_of(key)];
  if (slot.voxel != kNone) {
    return slot.voxel;
  }
  std::uint32_t id = static_cast<std::uint32_t>(pool_.size());
  if (free_.empty()) {
    pool_.emplace_back();
    planes_.emplace_back();
    tilts_.emplace_back();
  } else {
    id = free_.back();
    free_.pop_back();
  }
  pool_[id].key = key;
  slot = {key, id, 0};
  if (++used_ * 2 > slots_.size()) {
    grow();
  }
  return id;
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
  const double radius2 = radius_m * radius_m;
  const std::size_t slice = pool_.size() / kEvictionRounds + 1;
  for (std::size_t i = 0; i < slice && !pool_.empty(); ++i) {
    eviction_cursor_ = (eviction_cursor_ + 1) % pool_.size();
    const Voxel& voxel = pool_[eviction_cursor_];
    if (voxel.count > 0 && (centre_of(voxel_of_key(voxel.key)) - centre).squaredNorm() > radius2) {
      erase(static_cast<std::uint32_t>(eviction_cursor_));
    }
  }
}

void PlaneGrid::centroids(std::vector<Eigen::Vector3f>& out) const {
  for (const Voxel& voxel : pool_) {
    if (voxel.count > 0) {
      out.push_back((centre_of(voxel_of_key(voxel.key)) + voxel.sum.cast<double>() / voxel.count).cast<float>());
    }
  }
}

}  // namespace rilo
