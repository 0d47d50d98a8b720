// Voxel downsampling: the mean of the points of every voxel.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"

namespace rilo {

/// Replaces the points of each voxel by their mean, at their mean offset and intensity. On a plane the mean lies in the
/// plane, with the noise of one point divided by the root of their number, and over several beams: what a subset would
/// throw away. The table of visited voxels is reused from call to call. Points must be finite.
class VoxelMean {
 public:
  /// Writes one point per voxel of `voxel_m` to `out`, in the order in which the voxels first appear in `in`. Points
  /// count as often as `in.counts` says. Points of the two halves of a sweep are kept apart: where a turn of the sensor
  /// begins and ends, those of one place may lie a whole turn apart in time. `out` must not be `in`.
  void average(const TimedCloud& in, double voxel_m, TimedCloud& out);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;  // the slot is taken when this equals generation_
    std::uint32_t number = 0;      // of the voxel's mean
  };
  // Sums relative to a voxel's first point: exact in single precision however many there are.
  struct Mean {
    Eigen::Vector3f first;
    float first_offset_s;
    Eigen::Vector3f sum;
    float offset_sum_s;
    float count;
  };
  void find_keys(const TimedCloud& in, double voxel_m);
  void start();
  std::uint32_t number_of(std::uint64_t key);
  void grow();
  void add_intensity(std::uint32_t number, float intensity);
  void write(bool timed, TimedCloud& out) const;

  std::vector<std::uint64_t> keys_;  // of the points
  std::vector<Slot> slots_;
  std::uint32_t generation_ = 0;
  std::vector<Mean> means_;
  std::vector<float> intensity_sums_;  // of the means; empty without intensities
};

}  // namespace rilo
