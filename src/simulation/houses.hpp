// Rows of houses.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/ground.hpp"
#include "simulation/solid.hpp"

namespace rilo::simulation {

constexpr double kFrontM = 8.6;  ///< house fronts from a street's centre, at the least

/// Houses along both sides of every street and across the ends of the side streets, with windows, doors, pilasters,
/// string courses and balconies.
void add_houses(const Ground& ground, std::uint64_t seed, std::vector<Solid>& solids);

}  // namespace rilo::simulation
