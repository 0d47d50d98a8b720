#include "simulation/town.hpp"

#include <utility>

#include "simulation/course.hpp"
#include "simulation/street_sides.hpp"

namespace rilo::simulation {
namespace {

constexpr double kMarginM = 64;  // around the course: the side streets and the houses at their ends

using Segment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

Eigen::Vector2d street_centre(const DrivePath& path, double distance_m) {
  const Eigen::Vector2d d = path.direction(distance_m);
  return path.position(distance_m) + kLaneOffsetM * left_of(d);
}

// The street below the course follows its bends; the side streets are straight.
std::vector<Segment> centre_lines(const DrivePath& path) {
  constexpr double kPieceM = 2;
  std::vector<Segment> lines;
  for (double s = 0; s < path.lap_m(); s += kPieceM) {
    lines.emplace_back(street_centre(path, s), street_centre(path, s + kPieceM));
  }
  for (const StreetLeg& leg : street_legs()) {
    if (leg.side_street) lines.emplace_back(leg.begin, leg.end);
  }
  return lines;
}

Ground make_ground(const Terrain& terrain, const DrivePath& path) {
  Eigen::Vector2d low = path.position(0);
  Eigen::Vector2d high = low;
  for (double s = 0; s < path.lap_m(); s += 1) {
    low = low.cwiseMin(path.position(s));
    high = high.cwiseMax(path.position(s));
  }
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMarginM);
  return {terrain, centre_lines(path), low - margin, high + margin};
}

std::vector<Solid> make_solids(const Ground& ground, const TownConfig& config) {
  std::vector<Solid> solids;
  add_houses(ground, config.seed, solids);
  add_street_furniture(ground, config.seed, config.trees, solids);
  add_parked_cars(ground, config.seed, config.parked_cars, solids);
  return solids;
}

}  // namespace

Town::Town(const DrivePath& path, const TownConfig& config)
    : terrain_(config.seed),
      ground_(make_ground(terrain_, path)),
      solids_(make_solids(ground_, config), ground_.low(), ground_.high()) {}

void Town::cast(const Ray& ray, Hit& hit) const {
  ground_.cast(ray, hit);  // first: it takes a few steps, and bounds the walk through the grid's cells
  solids_.cast(ray, hit);
}

}  // namespace rilo::simulation
