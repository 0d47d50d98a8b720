// The map of a finished run, in the order in which it was seen.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// For each point of a map the first of `results` that was near it, or the nearest one.
std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results);

}  // namespace rilo
