// Are points without times raw, or compensated for the motion already?
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// The same sweeps, registered as they are and with the times of order_times(): with them, raw points are nearer to the
/// planes of the map, compensated ones are not.
struct CompensationTrial {
  std::size_t sweeps = 0;  ///< compared: those during which the sensor moved by more than the noise of good poses
  std::size_t better = 0;  ///< of these, with the times

  /// At least ten sweeps were compared.
  bool decided() const;
  /// Decided, and 0.6 of the sweeps are better.
  bool raw() const;
};

/// Opens the data twice, leaves out `start` sweeps, and reads the next ones, 100 at most, until 40 were compared. Empty
/// when the first has times, when its points do not lie in order, or when nothing is compensated (`preprocess.deskew`
/// off). Ends early at the end of the data, at an error, and when `interrupted` (empty: never) is true. The outcome
/// does not depend on the threads.
CompensationTrial try_compensation(const std::function<std::unique_ptr<ScanSource>()>& open, std::size_t start,
                                   OdometryConfig config, const std::function<bool()>& interrupted);

}  // namespace rilo
