// How far sweeps are apart, by the stamps of several, and how long one takes.
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

/// How long a sensor turns for a sweep, of which there is one every `period_s`. Sensors that turn take 0.2 s at most:
/// where sweeps are farther apart some were left out, and a turn is taken for the whole share nearest to 0.1 s.
double turn_s(double period_s);

/// Adds a warning where sweeps are farther apart than a turn: the times of points are a guess then.
void note_left_out(double period_s, double turn_s, std::vector<std::string>& warnings);

/// Warns of a period that no LiDAR has: its stamps, `of` something, are in another unit.
void note_odd_period(const std::string& of, SourceInfo& info);

}  // namespace rilo::detail
