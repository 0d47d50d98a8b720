// Are points without times raw, or compensated for the motion already?
#pragma once

#include <cstddef>
#include <functional>

#include "rilo/odometry/odometry_config.hpp"
#include "rilo/session/session.hpp"
#include "rilo/session/session_observer.hpp"

namespace rilo {

/// Opens the data twice, at 5 Hz three times, leaves out `start` sweeps, and reads the next ones, 300 at most, until 40
/// were compared, or 20 lost and no more compared. Empty when points without times neither lie in order nor all
/// round, or when nothing is compensated (`preprocess.deskew` off). Ends early at the end of the data, at an error, and
/// when `interrupted` (empty: never) is true. The outcome does not depend on the threads. `times_slower`: sweeps come
/// so many times as far apart as the data say; a turn takes as long all the same.
CompensationTrial try_compensation(const OpenSource& open, std::size_t start, OdometryConfig config,
                                   const std::function<bool()>& interrupted, int times_slower = 1);

}  // namespace rilo
