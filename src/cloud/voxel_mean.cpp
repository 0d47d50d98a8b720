#include "cloud/voxel_mean.hpp"

#include <algorithm>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr std::uint64_t kSecondHalf = 1ULL << 63U;  // a bit that voxel_key leaves free
constexpr std::size_t kFirstMeanSlots = 1U << 12U;  // grows by itself; a power of two
constexpr std::size_t kAhead = 16;                  // the table's memory is prefetched this many points ahead
}  // namespace

void VoxelMean::find_keys(const TimedCloud& in, double voxel_m) {
  const bool timed = in.timed();
  const double inverse = 1.0 / voxel_m;
  keys_.resize(in.size());
  for_fixed_chunks(in.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint64_t half = timed && in.offsets_s[i] > 0.0F ? kSecondHalf : 0U;
      keys_[i] = voxel_key(voxel_of(in.points[i], inverse)) | half;
    }
  });
}

void VoxelMean::start() {
  means_.clear();
  intensity_sums_.clear();
  if (slots_.empty() || ++generation_ == 0) {  // after 2^32 calls the old marks would come back to life
    slots_.assign(std::max(kFirstMeanSlots, slots_.size()), Slot{});
    generation_ = 1;
  }
}

/// Number of the mean of the voxel `key`; that of the next one to come if the voxel is new.
std::uint32_t VoxelMean::number_of(std::uint64_t key) {
  const std::uint64_t mask = slots_.size() - 1;
  std::uint64_t slot = mix_key(key) & mask;
  while (slots_[slot].generation == generation_) {
    if (slots_[slot].key == key) {
      return slots_[slot].number;
    }
    slot = (slot + 1) & mask;
  }
  const auto next = static_cast<std::uint32_t>(means_.size());
  slots_[slot] = {key, generation_, next};
  if (means_.size() * 2 > slots_.size()) {
    grow();
  }
  return next;
}

void VoxelMean::grow() {
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
  const std::uint64_t mask = slots_.size() - 1;
  for (const Slot& taken : old) {
    if (taken.generation != generation_) {
      continue;
    }
    std::uint64_t slot = mix_key(taken.key) & mask;
    while (slots_[slot].generation == generation_) {
      slot = (slot + 1) & mask;
    }
    slots_[slot] = taken;
  }
}

// `intensity` counts as often as the point it is of.
void VoxelMean::add_intensity(std::uint32_t number, float intensity) {
  if (number == intensity_sums_.size()) {
    intensity_sums_.push_back(intensity);
  } else {
    intensity_sums_[number] += intensity;
  }
}

void VoxelMean::average(const TimedCloud& in, double voxel_m, TimedCloud& out) {
  const bool timed = in.timed();
  find_keys(in, voxel_m);
  start();
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (i + kAhead < in.size()) {
      __builtin_prefetch(&slots_[mix_key(keys_[i + kAhead]) & (slots_.size() - 1)]);
    }
    // Along a beam many points in a row share a voxel.
    if (i == 0 || keys_[i] != keys_[i - 1]) {
      number = number_of(keys_[i]);
    }
    const Eigen::Vector3f& p = in.points[i];
    const float offset = timed ? in.offsets_s[i] : 0.0F;
    const float count = in.counts.empty() ? 1.0F : in.counts[i];
    if (!in.intensities.empty()) {
      add_intensity(number, count * in.intensities[i]);
    }
    if (number == means_.size()) {
      means_.push_back({p, offset, Eigen::Vector3f::Zero(), 0.0F, count});
      continue;
    }
    Mean& mean = means_[number];
    mean.sum += count * (p - mean.first);
    mean.offset_sum_s += count * (offset - mean.first_offset_s);
    mean.count += count;
  }
  write(timed, out);
}

void VoxelMean::write(bool timed, TimedCloud& out) const {
  out.points.resize(means_.size());
  out.counts.resize(means_.size());
  out.offsets_s.resize(timed ? means_.size() : 0);
  out.intensities.resize(intensity_sums_.size());
  for (std::size_t n = 0; n < means_.size(); ++n) {
    const Mean& mean = means_[n];
    out.points[n] = mean.first + mean.sum / mean.count;
    out.counts[n] = mean.count;
    if (timed) {
      out.offsets_s[n] = mean.first_offset_s + mean.offset_sum_s / mean.count;
    }
    if (!intensity_sums_.empty()) {
      out.intensities[n] = intensity_sums_[n] / mean.count;
    }
  }
}

}  // namespace rilo
