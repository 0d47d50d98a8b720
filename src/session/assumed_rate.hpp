// Whether a rate that was assumed can be that of the sweeps.
#pragma once

#include <string>
#include <vector>

#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// A sentence about data without stamps of which several sweeps are lost, or lie where no sensor can have moved to at
/// the rate that was assumed. Empty: the data has stamps, or they are few.
std::string doubtful_rate(const SourceInfo& info, const std::vector<SweepResult>& results);

}  // namespace rilo
