// Finds the bodies along a ray.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/ray.hpp"
#include "simulation/solid.hpp"

namespace rilo::simulation {

/// Uniform grid in the plane; each cell lists the bodies whose bounding box touches it. A town is flat: height would
/// not part them any further.
class SolidGrid {
 public:
  SolidGrid(std::vector<Solid> solids, const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  /// Offers the nearest body that the ray, beginning inside the grid, meets within hit.range_m.
  void cast(const Ray& ray, Hit& hit) const;
  const std::vector<Solid>& solids() const { return solids_; }

 private:
  struct CellRange {
    int first_column, last_column, first_row, last_row;
  };
  // Upright cylinder around a body: what most bodies of a cell are ruled out by, without reading them.
  struct Bounds {
    Eigen::Vector2d centre;
    double squared_radius;
    double low, high;
  };
  CellRange cells_of(const Solid& solid) const;
  static Bounds bounds_of(const Solid& solid);
  void cast_in_cell(std::size_t cell, const Ray& ray, double enter, double leave, Hit& hit) const;

  std::vector<Solid> solids_;
  std::vector<Bounds> bounds_;
  Eigen::Vector2d low_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> begin_;  // of each cell's part of members_
  std::vector<std::uint32_t> members_;
};

}  // namespace rilo::simulation
