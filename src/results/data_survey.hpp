// What the sweeps of a data set hold, by a look at some of them.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud/azimuth_sector.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {

struct DataSurvey {
  bool complete = false;  ///< every sweep was looked at
  std::size_t sweeps = 0;
  std::size_t read = 0;
  std::size_t points = 0;
  std::size_t least = 0;
  std::size_t most = 0;
  std::size_t not_finite = 0;
  std::size_t near_axis = 0;                ///< of all points: where some drivers put what did not return
  std::size_t usable = 0;                   ///< neither too near nor too far, of those in `ranges`
  std::vector<double> ranges;               ///< of some points of each sweep, m
  std::bitset<kAzimuthSectors> directions;  ///< in which any sweep has points
  std::size_t sectors_max = 0;              ///< of one sweep
  std::vector<std::int64_t> stamps;
  float times_begin = 0;
  float times_end = 0;
  bool timed = false;
  bool in_order = false;  ///< the points of the first sweep, as a spinning sensor measured them
  int rings = 0;
  bool intensity = false;
};

/// Reads about fifty sweeps of `source`, spread evenly over the data by skipping, or `all`. @throws IoError
DataSurvey survey_of(ScanSource& source, bool all);

}  // namespace rilo
