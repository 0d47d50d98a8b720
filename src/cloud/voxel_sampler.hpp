// Voxel downsampling: the first point of every voxel.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Keeps one point per voxel. The table of visited voxels is reused from call to call, so that nothing is allocated in
/// the steady state. Points must be finite.
class VoxelSampler {
 public:
  /// Indices into `points` of the first point of every voxel of `voxel_m`, in the order of the points.
  const std::vector<std::uint32_t>& sample(const std::vector<Eigen::Vector3f>& points, double voxel_m);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;  // the slot is taken when this equals generation_
  };
  void prepare(std::size_t count);

  std::vector<Slot> slots_;
  std::uint32_t generation_ = 0;
  std::vector<std::uint32_t> kept_;
};

}  // namespace rilo
