// Where a run had to begin its map again.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rilo/odometry/known_velocity.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// A sentence about the maps that begin after the first one, with the places of their first sweeps in the data:
/// `indices`, one per result. Empty: none does. Poses on both sides of such a sweep are connected by a guess.
std::string further_maps(const std::vector<SweepResult>& results, const std::vector<std::size_t>& indices);

/// The velocity of the first sweep that was registered, if maps had begun in vain before it: to begin with in another
/// pass.
std::optional<KnownVelocity> velocity_after_late_beginning(const std::vector<SweepResult>& results);

}  // namespace rilo
