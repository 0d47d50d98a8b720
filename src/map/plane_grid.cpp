#include "rilo/map/plane_grid.hpp"

#include <algorithm>
#include <cmath>

#include "rilo/geometry/symmetric_eigen.hpp"

namespace rilo {

namespace {
constexpr std::size_t kFirstSlots = 1U << 12U;
constexpr double kFaceShare = 0.2;  // a face is near within this share of the voxel
}  // namespace

PlaneGrid::PlaneGrid(double voxel_m, const PlaneCriteria& criteria)
    : voxel_m_(voxel_m), inverse_(1.0 / voxel_m), criteria_(criteria), slots_(kFirstSlots) {}

Eigen::Vector3d PlaneGrid::centre_of(const VoxelIndex& index) const {
  return voxel_m_ * Eigen::Vector3d(index.x + 0.5, index.y + 0.5, index.z + 0.5);
}

void PlaneGrid::insert(const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever) {
  const VoxelIndex index = voxel_of(p, inverse_);
  const std::uint32_t id = find_or_add(index);
  Voxel& voxel = pool_[id];
  if (voxel.count >= criteria_.max_points) {
    return;
  }
  const Eigen::Vector3f d = (p - centre_of(index)).cast<float>();
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
  for (Voxel& voxel : pool_) {
    if (voxel.count == 0) {
      continue;
    }
    // Every point moves by the mean: what differs between them is of second order.
    const auto n = static_cast<float>(voxel.count);
    const Eigen::Vector3d centroid = centre_of(voxel.index) + (voxel.sum / n).cast<double>();
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
    voxel.mean += shift;
  }
}

void PlaneGrid::refit() {
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::uint32_t id : touched_) {
    // An eviction in between may have freed the place, and an insertion taken it anew.
    if (!pool_[id].free && pool_[id].count >= criteria_.min_points) {
      fit(pool_[id]);
    }
  }
  touched_.clear();
}

void PlaneGrid::fit(Voxel& voxel) const {
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
  const bool planar = middle > extent * extent && smallest < criteria_.max_planarity * middle;
  voxel.mean = mean.cast<float>();
  voxel.normal = eigen.vectors.col(0).cast<float>();
  voxel.thickness = planar ? static_cast<float>(std::sqrt(smallest)) : -1.0F;
}

bool PlaneGrid::find(const Eigen::Vector3d& p, MapPlane& plane) const {
  const VoxelIndex index = voxel_of(p, inverse_);
  if (plane_of(index, plane)) {
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
  return plane_of(behind, plane);
}

bool PlaneGrid::occupied(const Eigen::Vector3d& p) const {
  return find_voxel(voxel_key(voxel_of(p, inverse_))) != kNone;
}

bool PlaneGrid::plane_of(const VoxelIndex& index, MapPlane& plane) const {
  const std::uint32_t id = find_voxel(voxel_key(index));
  if (id == kNone || pool_[id].thickness < 0.0F) {
    return false;
  }
  const Voxel& voxel = pool_[id];
  plane.point = centre_of(index) + voxel.mean.cast<double>();
  plane.normal = voxel.normal.cast<double>();
  plane.thickness_m = voxel.thickness;
  plane.elevation_lever = voxel.lever_sum / static_cast<float>(voxel.count);
  return true;
}

std::uint32_t PlaneGrid::find_voxel(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = mix_key(key) & mask;; slot = (slot + 1) & mask) {
    if (slots_[slot].voxel == kNone || slots_[slot].key == key) {
      return slots_[slot].voxel;
    }
  }
}

std::uint32_t PlaneGrid::find_or_add(const VoxelIndex& index) {
  const std::uint64_t key = voxel_key(index);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = mix_key(key) & mask;
  while (slots_[slot].voxel != kNone) {
    if (slots_[slot].key == key) {
      return slots_[slot].voxel;
    }
    slot = (slot + 1) & mask;
  }
  std::uint32_t id = static_cast<std::uint32_t>(pool_.size());
  if (free_.empty()) {
    pool_.emplace_back();
  } else {
    id = free_.back();
    free_.pop_back();
    pool_[id] = Voxel{};
  }
  pool_[id].free = false;
  pool_[id].key = key;
  pool_[id].index = index;
  slots_[slot] = {key, id};
  if (++used_ * 2 > slots_.size()) {
    grow();
  }
  return id;
}

void PlaneGrid::grow() {
  slots_.assign(slots_.size() * 2, Slot{});
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t id = 0; id < pool_.size(); ++id) {
    if (pool_[id].free) {
      continue;
    }
    std::size_t slot = mix_key(pool_[id].key) & mask;
    while (slots_[slot].voxel != kNone) {
      slot = (slot + 1) & mask;
    }
    slots_[slot] = {pool_[id].key, id};
  }
}

void PlaneGrid::erase(std::uint32_t voxel) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t hole = mix_key(pool_[voxel].key) & mask;
  while (slots_[hole].voxel != voxel) {
    hole = (hole + 1) & mask;
  }
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
    if (voxel.count > 0 && (centre_of(voxel.index) - centre).squaredNorm() > radius2) {
      erase(static_cast<std::uint32_t>(eviction_cursor_));
    }
  }
}

void PlaneGrid::centroids(std::vector<Eigen::Vector3f>& out) const {
  for (const Voxel& voxel : pool_) {
    if (voxel.count > 0) {
      out.push_back((centre_of(voxel.index) + voxel.sum.cast<double>() / voxel.count).cast<float>());
    }
  }
}

}  // namespace rilo
