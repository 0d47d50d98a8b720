// Everything that stands still, laid out along the streets.
#pragma once

#include <cstdint>

#include "simulation/drive_path.hpp"
#include "simulation/ground.hpp"
#include "simulation/solid.hpp"
#include "simulation/solid_grid.hpp"
#include "simulation/terrain.hpp"

namespace rilo::simulation {

struct TownConfig {
  std::uint64_t seed = 1;
  double parked_cars = 0.5;
  double trees = 0.6;
};

/// Houses in rows along every street, lamp posts, signs, trees, bins and parked cars.
class Town {
 public:
  Town(const DrivePath& path, const TownConfig& config);

  const Terrain& terrain() const { return terrain_; }
  void cast(const Ray& ray, Hit& hit) const;

 private:
  Terrain terrain_;
  Ground ground_;
  SolidGrid solids_;
};

}  // namespace rilo::simulation
