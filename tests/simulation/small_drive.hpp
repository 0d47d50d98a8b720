// A short drive for tests that need sweeps rather than a place.
#pragma once

#include <cstddef>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::test {

/// Motion-compensated sweeps of a VLP-16.
inline std::vector<Sweep> small_drive(std::size_t sweeps) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = sweeps;
  config.start_s = 10.0;
  config.deskewed = true;
  const DriveSimulator simulator(config);
  std::vector<Sweep> drive;
  for (std::size_t i = 0; i < sweeps; ++i) drive.push_back(simulator.sweep(i).sweep);
  return drive;
}

}  // namespace rilo::test
