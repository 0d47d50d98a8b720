#pragma once

namespace rilo {

/// How long a sweep may take.
struct TimeBudgetConfig {
  double sweep_ms = 0.0;  ///< from motion compensation to map update; 0: as long as it takes
};

}  // namespace rilo
