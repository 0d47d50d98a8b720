#include "map/plane_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace rilo {

namespace {
constexpr double kFaceShare = 0.2;  // of the voxel: a point this near to a face may belong to the surface behind it
}  // namespace

PlaneGrid::PlaneGrid(double voxel_m, const PlaneCriteria& criteria)
    : voxel_m_(voxel_m), inverse_(1.0 / voxel_m), criteria_(criteria), lines_(kFirstVoxelSlots / kLineSlots) {}

Eigen::Vector3d PlaneGrid::centre_of(const Voxel& voxel) const { return centre_of(voxel_of_key(voxel.key, place_)); }

void PlaneGrid::insert(const InsertedPoint& point) {
  const VoxelIndex index = index_of(point.place);
  add({index, find_or_add(voxel_key(index)).voxel, {&point, 1}});
}

void PlaneGrid::insert(const std::vector<InsertedPoint>& points) {
  std::vector<InsertedVoxel> voxels;
  voxels.reserve(points.size());
  for (const InsertedPoint& point : points) {
    voxels.emplace_back(index_of(point.place));
  }
  insert(points, voxels, 0);
}

void PlaneGrid::insert(const std::vector<InsertedPoint>& points, const std::vector<InsertedVoxel>& voxels,
                       int doublings) {
  // While the points of some runs are added, the slots of the next are on their way from memory.
  std::array<std::array<Run, kLookUpsInFlight>, 2> batches;
  std::size_t from = 0;
  std::size_t coming = collect(points, voxels, doublings, from, batches[0]);
  for (std::size_t turn = 0; coming > 0; turn ^= 1U) {
    auto& runs = batches[turn];
    const std::size_t count = std::exchange(coming, collect(points, voxels, doublings, from, batches[turn ^ 1U]));
    std::size_t open = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Slot& slot = find_or_add(voxel_key(runs[i].index));
      if (!slot.full) {
        runs[i].voxel = slot.voxel;
        prefetch_voxel(slot.voxel);
        runs[open++] = runs[i];
      }
    }
    for (std::size_t i = 0; i < open; ++i) {
      add(runs[i]);
    }
  }
}

std::size_t PlaneGrid::collect(std::span<const InsertedPoint> points, const std::vector<InsertedVoxel>& voxels,
                               int doublings, std::size_t& from, std::span<Run> runs) const {
  std::size_t count = 0;
  for (; count < runs.size() && from < points.size(); ++count) {
    const VoxelIndex& fine = voxels[from].index;
    const VoxelIndex index{fine.x >> doublings, fine.y >> doublings, fine.z >> doublings};
    prefetch(index);
    const std::size_t first = from++;
    while (from < points.size() && voxels[from].doublings_apart <= doublings) {
      ++from;
    }
    runs[count] = {index, kNone, points.subspan(first, from - first)};
  }
  return count;
}

void PlaneGrid::Voxel::forget_half() {
  const std::int32_t kept = count / 2;
  const float share = static_cast<float>(kept) / static_cast<float>(count);
  count = kept;
  fitted_count = kept;
  sum *= share;
  squares *= share;
  elevation_jacobian_sum *= share;
  ray_sum *= share;
}

inline void PlaneGrid::Voxel::add(const Eigen::Vector3f& d, const InsertedPoint& point) {
  sum += d;
  elevation_jacobian_sum += point.elevation_jacobian;
  ray_sum += point.ray;
  squares[0] += d.x() * d.x();
  squares[1] += d.x() * d.y();
  squares[2] += d.x() * d.z();
  squares[3] += d.y() * d.y();
  squares[4] += d.y() * d.z();
  squares[5] += d.z() * d.z();
  ++count;
}

void PlaneGrid::add(const Run& run) {
  Voxel& voxel = pool_[run.voxel];
  const Eigen::Vector3d centre = centre_of(run.index);
  for (const InsertedPoint& point : run.points) {
    if (voxel.count >= criteria_.max_points) {
      if (voxel.fit != Fit::kNoPlane) {
        slot_at(slot_of(voxel.key)).full = voxel.fit == Fit::kPlane;
        return;
      }
      voxel.forget_half();
    }
    voxel.add((point.place - centre).cast<float>(), point);
    // Refit when the evidence has grown by half: a plane is fitted about log(n) times in its life, not n times.
    if (voxel.count >= criteria_.min_points && 2 * voxel.count >= 3 * voxel.fitted_count) {
      touched_.push_back(run.voxel);
      voxel.fitted_count = voxel.count;
    }
  }
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
  const Slot& slot = slot_at(slot_of(voxel_key(index)));
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

bool PlaneGrid::occupied(const Eigen::Vector3d& p) const {
  return slot_at(slot_of(voxel_key(voxel_of(p, inverse_)))).voxel != kNone;
}

PlaneGrid::Slot& PlaneGrid::find_or_add(std::uint64_t key) {
  Slot& slot = slot_at(slot_of(key));
  if (slot.voxel != kNone) {
    return slot;
  }
  std::uint32_t id = static_cast<std::uint32_t>(pool_.size());
  if (free_.empty()) {
    pool_.grow();
    planes_.grow();
    extents_.grow();
  } else {
    id = free_.back();
    free_.pop_back();
  }
  pool_[id].key = key;
  slot = {key, id, Kind::kNone, false};
  if (++used_ * 2 <= last_slot() + 1) {
    return slot;
  }
  grow();
  return slot_at(slot_of(key));
}

void PlaneGrid::grow() {
  const std::vector<SlotLine> old = std::exchange(lines_, std::vector<SlotLine>(lines_.size() * 2));
  for (const SlotLine& line : old) {
    for (const Slot& slot : line.slots) {
      if (slot.voxel != kNone) {
        slot_at(slot_of(slot.key)) = slot;
      }
    }
  }
}

void PlaneGrid::erase(std::uint32_t voxel) {
  const std::size_t mask = last_slot();
  std::size_t hole = slot_of(pool_[voxel].key);
  // Backward shift: later entries of the probe sequence move up, so that no tombstones slow the look-ups down.
  for (std::size_t next = (hole + 1) & mask; slot_at(next).voxel != kNone; next = (next + 1) & mask) {
    const std::size_t home = home_of(slot_at(next).key);
    if (((next - home) & mask) >= ((next - hole) & mask)) {
      slot_at(hole) = slot_at(next);
      hole = next;
    }
  }
  slot_at(hole) = Slot{};
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
  for (std::size_t id = 0; id < pool_.size(); ++id) {
    const Voxel& voxel = pool_[id];
    if (voxel.count > 0) {
      out.push_back((centre_of(voxel) + voxel.sum.cast<double>() / voxel.count).cast<float>());
    }
  }
}

}  // namespace rilo
