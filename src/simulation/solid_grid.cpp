#include "simulation/solid_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rilo::simulation {
namespace {

constexpr double kCellM = 2.0;

}  // namespace

SolidGrid::SolidGrid(std::vector<Solid> solids, const Eigen::Vector2d& low, const Eigen::Vector2d& high)
    : solids_(std::move(solids)), low_(low) {
  columns_ = static_cast<int>(std::ceil((high.x() - low.x()) / kCellM));
  rows_ = static_cast<int>(std::ceil((high.y() - low.y()) / kCellM));
  const auto for_each_cell = [this](const Solid& s, const auto& visit) {
    const CellRange cells = cells_of(s);
    for (int r = cells.first_row; r <= cells.last_row; ++r) {
      for (int c = cells.first_column; c <= cells.last_column; ++c) visit(static_cast<std::size_t>(r * columns_ + c));
    }
  };
  // Count, then fill: every cell's members lie side by side.
  begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Solid& s : solids_) for_each_cell(s, [this](std::size_t cell) { ++begin_[cell + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  members_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  bounds_.reserve(solids_.size());
  for (const Solid& s : solids_) bounds_.push_back(bounds_of(s));
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    for_each_cell(solids_[i], [&](std::size_t cell) { members_[next[cell]++] = i; });
  }
}

SolidGrid::CellRange SolidGrid::cells_of(const Solid& solid) const {
  const Eigen::Vector2d first = (solid.centre.head<2>() - solid.extent() - low_) / kCellM;
  const Eigen::Vector2d last = (solid.centre.head<2>() + solid.extent() - low_) / kCellM;
  const auto cell = [](double g, int count) { return static_cast<int>(std::clamp(std::floor(g), 0.0, count - 1.0)); };
  return {cell(first.x(), columns_), cell(last.x(), columns_), cell(first.y(), rows_), cell(last.y(), rows_)};
}

SolidGrid::Bounds SolidGrid::bounds_of(const Solid& solid) {
  constexpr double kSlackM = 1e-6;  // hits are rounded
  const double radius = solid.half.head<2>().norm() + kSlackM;
  return {solid.centre.head<2>(), radius * radius, solid.centre.z() - solid.half.z() - kSlackM,
          solid.centre.z() + solid.half.z() + kSlackM};
}

// The part of the ray from range `enter` to `leave` passes through the cell.
void SolidGrid::cast_in_cell(std::size_t cell, const Ray& ray, double enter, double leave, Hit& hit) const {
  const double z_in = ray.origin.z() + enter * ray.direction.z();
  const double z_out = ray.origin.z() + leave * ray.direction.z();
  const double low = std::min(z_in, z_out);
  const double high = std::max(z_in, z_out);
  const Eigen::Vector2d d = ray.direction.head<2>();
  for (std::uint32_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
    const Bounds& b = bounds_[members_[k]];
    if (b.low > high || b.high < low) continue;
    const Eigen::Vector2d to = b.centre - ray.origin.head<2>();
    const double aside = d.x() * to.y() - d.y() * to.x();
    if (aside * aside > b.squared_radius * d.squaredNorm()) continue;
    simulation::cast(solids_[members_[k]], ray, hit);
  }
}

void SolidGrid::cast(const Ray& ray, Hit& hit) const {
  const Eigen::Vector2d g = (ray.origin.head<2>() - low_) / kCellM;
  Eigen::Array2i cell(static_cast<int>(std::floor(g.x())), static_cast<int>(std::floor(g.y())));
  Eigen::Array2d next;
  Eigen::Array2d step;
  for (int i = 0; i < 2; ++i) {
    const double d = ray.direction[i];
    step[i] = d == 0 ? kInfinity : kCellM / std::abs(d);
    next[i] = d == 0 ? kInfinity : (cell[i] + (d > 0 ? 1 : 0) - g[i]) * kCellM / d;
  }
  double range = 0;
  while (range < hit.range_m && cell.x() >= 0 && cell.x() < columns_ && cell.y() >= 0 && cell.y() < rows_) {
    const auto index = static_cast<std::size_t>(cell.y() * columns_ + cell.x());
    const int axis = next[0] < next[1] ? 0 : 1;
    cast_in_cell(index, ray, range, std::min(next[axis], hit.range_m), hit);
    range = next[axis];
    if (range == kInfinity) return;
    next[axis] += step[axis];
    cell[axis] += ray.direction[axis] > 0 ? 1 : -1;
  }
}

}  // namespace rilo::simulation
