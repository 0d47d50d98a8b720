// What stands between the road and the houses.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/ground.hpp"
#include "simulation/solid.hpp"

namespace rilo::simulation {

/// Lamp posts, signs, trees (at a share `trees` of their places), bins, cabinets and bollards on the pavements.
void add_street_furniture(const Ground& ground, std::uint64_t seed, double trees, std::vector<Solid>& solids);

/// Cars at a share `parked_cars` of the parking places along both kerbs.
void add_parked_cars(const Ground& ground, std::uint64_t seed, double parked_cars, std::vector<Solid>& solids);

}  // namespace rilo::simulation
