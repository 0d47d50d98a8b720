#include "cloud/voxel_sampler.hpp"

#include <bit>

#include "geometry/voxel_key.hpp"

namespace rilo {

void VoxelSampler::prepare(std::size_t count) {
  const std::size_t wanted = std::bit_ceil(count * 2 + 16);
  if (slots_.size() < wanted) {
    slots_.assign(wanted, Slot{});
    generation_ = 0;
  }
  if (++generation_ == 0) {  // after 2^32 calls the old marks would come back to life
    slots_.assign(slots_.size(), Slot{});
    generation_ = 1;
  }
  kept_.clear();
}

const std::vector<std::uint32_t>& VoxelSampler::sample(const std::vector<Eigen::Vector3f>& points, double voxel_m) {
  prepare(points.size());
  const std::uint64_t mask = slots_.size() - 1;
  const double inverse = 1.0 / voxel_m;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint64_t key = voxel_key(voxel_of(points[i], inverse));
    std::uint64_t slot = mix_key(key) & mask;
    while (slots_[slot].generation == generation_ && slots_[slot].key != key) {
      slot = (slot + 1) & mask;
    }
    if (slots_[slot].generation != generation_) {
      slots_[slot] = {key, generation_};
      kept_.push_back(i);
    }
  }
  return kept_;
}

}  // namespace rilo
