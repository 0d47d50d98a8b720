// What is driven, and with which sensor.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rilo/simulation/sensor_model.hpp"

namespace rilo {

/// A drive through a small town. Everything follows from these values alone: the same configuration gives the same
/// bytes, whatever `threads` is.
struct DriveConfig {
  std::uint64_t seed = 1;  ///< town, traffic and noise
  SensorKind sensor = SensorKind::kHdl64;
  std::size_t sweeps = 0;         ///< 10 a second; 0: one lap and 50 m of the next; at most 20000
  double start_s = 0;             ///< s, 0 … 2000: begin this far into the drive (0: standing)
  double speed_mps = 10.5;        ///< m/s, 2 … 15: on straight streets; bends are taken slower
  bool deskewed = false;          ///< points referred to the mid-sweep pose, without times; else each at its own time
  double noise_m = 0.015;         ///< m, 0 … 0.5: standard deviation of a range
  double dropout = 0.02;          ///< share 0 … 0.9 of returns that are lost
  double max_range_m = 0;         ///< m, 5 … the sensor's own; 0: the sensor's own
  double elevation_bias_deg = 0;  ///< degrees, -2 … 2: true minus reported elevation (KITTI's is near 0.205)
  std::size_t moving_cars = 6;    ///< 0 … 12: some ahead and behind, the others oncoming
  double parked_cars = 0.5;       ///< 0 … 1: share of the parking places that are taken
  double trees = 0.6;             ///< 0 … 1: share of the places for trees that have one
  int threads = 0;                ///< 0 … 1024; 0: as many as the machine has

  /// @throws std::invalid_argument naming the field, its value and its range.
  void validate() const;
};

}  // namespace rilo
