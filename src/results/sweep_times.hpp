// When the sweeps of data were measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// That time of the sweep, after its stamp (s), by its earliest and latest point; 0 without times.
float instant_s(const std::vector<float>& times_s, PoseInstant instant);

/// Of all sweeps of a data folder.
struct SweepTimes {
  std::vector<std::int64_t> stamps_ns;   ///< empty when they are known only by reading the data, or go back
  std::vector<std::int64_t> offsets_ns;  ///< poses may be stamped so much later, the likeliest first
};

SweepTimes sweep_times(const std::filesystem::path& data, PoseInstant instant);

}  // namespace rilo
