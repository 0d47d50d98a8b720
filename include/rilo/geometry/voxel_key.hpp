// Integer lattice of voxels and its hash key.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace rilo {

/// Index of a voxel; voxel (i, j, k) covers [i, i+1) × [j, j+1) × [k, k+1) voxel sizes.
struct VoxelIndex {
  int x = 0;
  int y = 0;
  int z = 0;
};

/// Voxel that holds `p`, with `inverse_size` = 1 / voxel size. Coordinates must be finite and within ±2^20 voxels.
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

/// Unique key of a voxel: 21 bits an axis. With 0.25 m voxels that is ±262 km.
inline std::uint64_t voxel_key(const VoxelIndex& v) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  const auto pack = [](int i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) & kMask; };
  return pack(v.x) | (pack(v.y) << 21U) | (pack(v.z) << 42U);
}

/// Voxel of a key of voxel_key().
inline VoxelIndex voxel_of_key(std::uint64_t key) {
  // Up against the sign bit, then back: the arithmetic shift brings the sign along.
  const auto unpack = [key](unsigned int shift) {
    return static_cast<int>(static_cast<std::int64_t>(key << (43U - shift)) >> 43);
  };
  return {unpack(0U), unpack(21U), unpack(42U)};
}

/// Mixes a key so that neighbouring voxels spread over the table (multiplicative hashing, upper bits are the good
/// ones).
inline std::uint64_t mix_key(std::uint64_t key) {
  key ^= key >> 32U;
  key *= 0x9E3779B97F4A7C15ULL;
  return key ^ (key >> 29U);
}

}  // namespace rilo
