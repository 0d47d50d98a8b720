// Returns of snowflakes and raindrops.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Finds returns with hardly another one near by. A surface that is near gives many returns side by side at about one
/// range; a flake or a drop gives one. They are counted in cells of equal angles and of a range that grows with the
/// range: 2.9° by 2.9° by 5 % of the range, more where the sensor has few beams. Keeps its buffers from sweep to sweep.
class IsolatedReturns {
 public:
  /// Looks at the points whose `valid` is not 0. Returns the share (0 … 1) of those within 30 m that are isolated: that
  /// share their cell with fewer than two others. Empty when the returns are too sparse to tell.
  std::optional<double> find(std::span<const Eigen::Vector3f> points, std::span<const std::uint8_t> valid) {
    return find(points, valid, kAll);
  }

  /// Whether more than the share `most` is isolated. Looks at a quarter of the points first: fewer neighbours, hence
  /// more that seem isolated, and in clear air the rest needs no look. After `true` as after find().
  bool more_than(double most, std::span<const Eigen::Vector3f> points, std::span<const std::uint8_t> valid) {
    return find(points, valid, kQuarter).value_or(1.0) > most && find(points, valid, kAll).value_or(0.0) > most;
  }

  /// Whether point i of the last sweep is isolated. Farther than 30 m none is: a pole or a bush may give one return.
  bool isolated(std::size_t i) const { return returns_[cells_[i]] < kLeastReturns; }

 private:
  static constexpr std::uint8_t kLeastReturns = 3;
  static constexpr std::uint32_t kCells = 1U << 20U;  // few of them are taken: hardly two at one place

  static constexpr std::size_t kAll = 1;      // every chunk of the points is looked at
  static constexpr std::size_t kQuarter = 4;  // every fourth one

  std::optional<double> find(std::span<const Eigen::Vector3f> points, std::span<const std::uint8_t> valid,
                             std::size_t stride);
  double find_cells(std::span<const Eigen::Vector3f> points, std::span<const std::uint8_t> valid, std::size_t stride,
                    double cell_rad);
  double count_isolated(std::size_t stride);

  std::vector<std::uint32_t> cells_;         // of the points; kCells: is not looked at
  std::vector<std::uint16_t> directions_;    // of the points
  std::vector<std::uint8_t> returns_;        // in each cell, counted up to kLeastReturns
  std::vector<std::uint8_t> direction_met_;  // 0 or 1
};

}  // namespace rilo
