// How long a sweep takes, by the stamps of several.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// Mean of the steps that move forward, in s, without gaps and bursts, which are off by more than half of the median
/// step: the median alone is a whole number of 10 ms where stamps are rounded to that. Nothing when there are none.
std::optional<double> mean_period_s(const std::vector<std::int64_t>& stamps);

/// Warns of a period that no LiDAR has: its stamps, `of` something, are in another unit.
void note_odd_period(const std::string& of, SourceInfo& info);

}  // namespace rilo::detail
