#include "rilo/cloud/voxel_mean.hpp"

#include <bit>

#include "rilo/geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr std::uint64_t kSecondHalf = 1ULL << 63U;  // a bit that voxel_key leaves free
}

void VoxelMean::prepare(std::size_t count) {
  const std::size_t wanted = std::bit_ceil(count * 2 + 16);
  if (slots_.size() < wanted) {
    slots_.assign(wanted, Slot{});
    generation_ = 0;
  }
  if (++generation_ == 0) {  // after 2^32 calls the old marks would come back to life
    slots_.assign(slots_.size(), Slot{});
    generation_ = 1;
  }
}

std::uint32_t VoxelMean::number_of(std::uint64_t key, std::uint32_t next) {
  const std::uint64_t mask = slots_.size() - 1;
  std::uint64_t slot = mix_key(key) & mask;
  while (slots_[slot].generation == generation_ && slots_[slot].key != key) {
    slot = (slot + 1) & mask;
  }
  if (slots_[slot].generation != generation_) {
    slots_[slot] = {key, generation_, next};
  }
  return slots_[slot].number;
}

void VoxelMean::average(const TimedCloud& in, double voxel_m, TimedCloud& out) {
  prepare(in.size());
  const bool timed = in.timed();
  const double inverse = 1.0 / voxel_m;
  out.points.clear();
  out.offsets_s.clear();
  out.counts.clear();
  sums_.clear();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Eigen::Vector3f& p = in.points[i];
    const float offset = timed ? in.offsets_s[i] : 0.0F;
    const float count = in.counts.empty() ? 1.0F : in.counts[i];
    const std::uint64_t half = offset > 0.0F ? kSecondHalf : 0U;
    const auto next = static_cast<std::uint32_t>(out.points.size());
    const std::uint32_t number = number_of(voxel_key(voxel_of(p, inverse)) | half, next);
    if (number == next) {
      out.points.push_back(p);
      if (timed) {
        out.offsets_s.push_back(offset);
      }
      out.counts.push_back(count);
      sums_.emplace_back(Eigen::Vector4f::Zero());
      continue;
    }
    sums_[number].head<3>() += count * (p - out.points[number]);
    if (timed) {
      sums_[number].w() += count * (offset - out.offsets_s[number]);
    }
    out.counts[number] += count;
  }
  for (std::size_t n = 0; n < out.size(); ++n) {
    out.points[n] += sums_[n].head<3>() / out.counts[n];
    if (timed) {
      out.offsets_s[n] += sums_[n].w() / out.counts[n];
    }
  }
}

}  // namespace rilo
