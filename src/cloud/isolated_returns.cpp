#include "cloud/isolated_returns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_block.hpp"

namespace rilo {

namespace {

constexpr double kCellRad = 0.05;
constexpr double kFarthestM = 30.0;            // flakes farther away hardly return
constexpr double kReturnsPerDirection = 14.0;  // about those of 16 beams with 1800 columns; with fewer cells are larger
constexpr double kFewestPerDirection = 4.0;    // with fewer than that neighbours say nothing
constexpr std::uint16_t kNoDirection = kPolarDirections;

/// 20 bits: the upper ones of the product are the good ones.
std::uint32_t hashed(std::uint32_t direction, std::uint32_t layer) {
  return ((direction << 10U | layer) * 0x9E3779B1U) >> 12U;
}

/// Calls use(begin, end) for every stride-th chunk of `count` points.
template <typename Use>
void for_chunks(std::size_t count, std::size_t stride, const Use& use) {
  for (std::size_t begin = 0; begin < count; begin += stride * kChunkSize) {
    use(begin, std::min(count, begin + kChunkSize));
  }
}

}  // namespace

std::optional<double> IsolatedReturns::find(std::span<const Eigen::Vector3f> points,
                                            std::span<const std::uint8_t> valid, std::size_t stride) {
  cells_.resize(points.size());
  directions_.resize(points.size());
  returns_.assign(kCells + 1, 0);
  returns_[kCells] = kLeastReturns;
  const double density = find_cells(points, valid, stride, kCellRad);
  if (density < kFewestPerDirection) {
    return std::nullopt;
  }
  if (density < kReturnsPerDirection) {
    find_cells(points, valid, stride, kCellRad * std::sqrt(kReturnsPerDirection / density));
  }
  return count_isolated(stride);
}

/// Returns the mean number of valid points over the directions that have some.
double IsolatedReturns::find_cells(std::span<const Eigen::Vector3f> points, std::span<const std::uint8_t> valid,
                                   std::size_t stride, double cell_rad) {
  const auto size_rad = static_cast<float>(cell_rad);
  const std::uint32_t last_layer = polar_layer(static_cast<float>(kFarthestM), size_rad);
  for_each_index((chunk_count(points.size()) + stride - 1) / stride, [&](std::size_t number) {
    const std::size_t begin = number * stride * kChunkSize;
    const std::size_t end = std::min(points.size(), begin + kChunkSize);
    PointBlock p;
    alignas(64) PointBlock::Lanes<std::uint32_t> directions;
    alignas(64) PointBlock::Lanes<std::uint32_t> layers;
    for_each_block(begin, end, [&](std::size_t first, std::size_t n) {
      p.load(&points[first], n);
      find_polar_cells(p, size_rad, directions, layers);
      for (std::size_t i = 0; i < n; ++i) {
        const bool looked_at = valid[first + i] != 0 && layers[i] <= last_layer;
        cells_[first + i] = looked_at ? hashed(directions[i], layers[i]) : kCells;
        directions_[first + i] = valid[first + i] != 0 ? static_cast<std::uint16_t>(directions[i]) : kNoDirection;
      }
    });
  });
  direction_met_.assign(kPolarDirections + 1, 0);
  std::size_t returns = 0;
  for_chunks(cells_.size(), stride, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      direction_met_[directions_[i]] = 1;
      returns += static_cast<std::size_t>(directions_[i] != kNoDirection);
    }
  });
  const auto met = std::accumulate(direction_met_.begin(), direction_met_.end() - 1, std::size_t{0});
  return met == 0 ? 0.0 : static_cast<double>(returns) / static_cast<double>(met);
}

/// Share of the points looked at that are isolated.
double IsolatedReturns::count_isolated(std::size_t stride) {
  // What one more return changes: two are isolated until the third comes.
  constexpr std::array<int, kLeastReturns + 1> kMore{1, 1, -2, 0};
  std::size_t looked_at = 0;
  int isolated = 0;
  for_chunks(cells_.size(), stride, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::uint8_t& returns = returns_[cells_[i]];
      isolated += kMore[returns];
      returns = static_cast<std::uint8_t>(returns + static_cast<std::uint8_t>(returns < kLeastReturns));
      looked_at += static_cast<std::size_t>(cells_[i] != kCells);
    }
  });
  return looked_at == 0 ? 0.0 : static_cast<double>(isolated) / static_cast<double>(looked_at);
}

}  // namespace rilo
