// Voxel downsampling: the mean of the points of every voxel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"

namespace rilo {

/// Replaces the points of each voxel by their mean, at their mean offset and intensity. On a plane the mean lies in the
/// plane, with the noise of one point divided by the root of their number, and over several beams: what a subset would
/// throw away. The tables of visited voxels are reused from call to call. Points must be finite.
class VoxelMean {
 public:
  /// Writes one point per voxel of `voxel_m` to `out`, in the order in which the voxels first appear in `in`. Points
  /// count as often as `in.counts` says. Points of the two halves of a sweep are kept apart: where a turn of the sensor
  /// begins and ends, those of one place may lie a whole turn apart in time. `out` must not be `in`.
  void average(const TimedCloud& in, double voxel_m, TimedCloud& out);

 private:
  // Sums relative to a voxel's first point: exact in single precision however many there are.
  struct Mean {
    Eigen::Vector3f first;
    float first_offset_s;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float offset_sum_s = 0.0F;
    float count = 0.0F;
    float intensity_sum = 0.0F;
    std::uint32_t first_index = 0;  // of the first point
  };
  /// Points in a row that share a voxel, as most do along a beam. Those of a chunk of points begin at the place of its
  /// first point.
  struct Runs {
    std::vector<std::uint64_t> keys;    // of the voxels
    std::vector<std::uint16_t> starts;  // first point, counted from that of the chunk
    std::vector<std::uint16_t> counts;  // runs of each chunk
  };
  /// The voxels on the left or on the right of the sensor. The two are worked on in parallel.
  class Side {
   public:
    /// Means of the points of `in` whose keys are of the side `number`; points are counted as often as `count_of`
    /// says.
    template <typename CountOf>
    void add_up(const TimedCloud& in, const Runs& runs, std::uint64_t number, const CountOf& count_of);
    /// In the order of their first points.
    const std::vector<Mean>& means() const { return means_; }

   private:
    struct Slot {
      std::uint64_t key = 0;
      std::uint32_t generation = 0;  // the slot is taken when this equals generation_
      std::uint32_t number = 0;      // of the voxel's mean
    };
    void start();
    /// Adds the points begin … end − 1 to the mean of the voxel `key`.
    template <typename CountOf>
    void add(const TimedCloud& in, std::uint64_t key, std::size_t begin, std::size_t end, const CountOf& count_of);
    std::uint32_t number_of(std::uint64_t key);
    void grow();

    std::vector<Slot> slots_;
    std::uint32_t generation_ = 0;
    std::vector<Mean> means_;
  };
  void find_runs(const TimedCloud& in, double voxel_m);
  template <typename CountOf>
  void add_up(const TimedCloud& in, const CountOf& count_of);
  void write(const TimedCloud& in, TimedCloud& out) const;

  Runs runs_;
  std::array<Side, 2> sides_;
};

}  // namespace rilo
