// What stands along the streets.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/ground.hpp"
#include "simulation/solid.hpp"

namespace rilo::simulation {

/// Houses along both sides of every street and across the ends of the side streets, with windows, doors, pilasters,
/// string courses and balconies.
void add_houses(const Ground& ground, std::uint64_t seed, std::vector<Solid>& solids);

/// Lamp posts, signs, trees (at a share `trees` of their places), bins, cabinets and bollards on the pavements.
void add_street_furniture(const Ground& ground, std::uint64_t seed, double trees, std::vector<Solid>& solids);

/// Cars at a share `parked_cars` of the parking places along both kerbs.
void add_parked_cars(const Ground& ground, std::uint64_t seed, double parked_cars, std::vector<Solid>& solids);

}  // namespace rilo::simulation
