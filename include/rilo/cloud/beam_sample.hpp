// Single measurements of a sweep, with their beams.
#pragma once

#include <vector>

#include "rilo/cloud/beam_index.hpp"
#include "rilo/cloud/timed_cloud.hpp"

namespace rilo {

/// Points as measured, not averaged over beams as those of the downsampled clouds are.
struct BeamSample {
  TimedCloud cloud;
  std::vector<Beam> beams;  ///< one a point
};

}  // namespace rilo
