// Integer lattice of voxels and its hash key.
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace rilo {

/// Index of a voxel; voxel (i, j, k) covers [i, i+1) × [j, j+1) × [k, k+1) voxel sizes.
struct VoxelIndex {
  int x = 0;
  int y = 0;
  int z = 0;

  bool operator==(const VoxelIndex&) const = default;
};

/// Voxel that holds `p`, with `inverse_size` = 1 / voxel size. Coordinates must be finite and within ±2^31 voxels
/// (21 000 km with 0.01 m voxels).
template <typename Derived>
inline VoxelIndex voxel_of(const Eigen::MatrixBase<Derived>& p, double inverse_size) {
  // floor by truncation: std::floor is a library call without SSE4.1, and this is the hottest line of the downsampling.
  const auto floor_int = [](double v) {
    const int i = static_cast<int>(v);
    return i - static_cast<int>(v < i);
  };
  return {floor_int(static_cast<double>(p.x()) * inverse_size), floor_int(static_cast<double>(p.y()) * inverse_size),
          floor_int(static_cast<double>(p.z()) * inverse_size)};
}

/// The low 21 bits of three indices.
inline std::uint64_t packed_voxel_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  return (x & kMask) | ((y & kMask) << 21U) | ((z & kMask) << 42U);
}

/// Key of a voxel: 21 bits an axis, so that it repeats every 2^21 voxels: 21 km with the smallest voxel of the map,
/// 0.01 m. Unique among voxels that lie within 2^20 voxels of one place, however far from the origin that is.
inline std::uint64_t voxel_key(const VoxelIndex& v) {
  return packed_voxel_key(static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y),
                          static_cast<std::uint32_t>(v.z));
}

/// Of the voxels that have this key the one nearest to `place`.
inline VoxelIndex voxel_of_key(std::uint64_t key, const VoxelIndex& place) {
  // From `place` the shortest way round: up against the sign bit, then back, as the arithmetic shift brings the sign.
  const auto unpack = [key](unsigned int shift, int from) {
    const std::uint64_t way = (key >> shift) - static_cast<std::uint64_t>(static_cast<std::int64_t>(from));
    return from + static_cast<int>(static_cast<std::int64_t>(way << 43U) >> 43);
  };
  return {unpack(0U, place.x), unpack(21U, place.y), unpack(42U, place.z)};
}

inline constexpr std::size_t kFirstVoxelSlots = 1U << 12U;  // of a hash table; grows by itself, a power of two
inline constexpr std::size_t kLookUpsInFlight = 16;  // as many as hide the latency of memory (docs/benchmarks.md)

/// Mixes a key so that neighbouring voxels spread over the table (multiplicative hashing, upper bits are the good
/// ones).
inline std::uint64_t mix_key(std::uint64_t key) {
  key ^= key >> 32U;
  key *= 0x9E3779B97F4A7C15ULL;
  return key ^ (key >> 29U);
}

}  // namespace rilo
