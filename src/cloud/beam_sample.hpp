// Single measurements of a sweep, with their beams.
#pragma once

#include <vector>

#include "cloud/beam_index.hpp"
#include "cloud/timed_cloud.hpp"

namespace rilo {

/// Points as measured, not averaged over beams as those of the downsampled clouds are.
struct BeamSample {
  TimedCloud cloud;
  std::vector<Beam> beams;  ///< one per point
};

}  // namespace rilo
