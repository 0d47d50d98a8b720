// Whether a rate that was assumed can be that of the sweeps.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

/// The first sweeps of data without stamps, at the rate that was assumed and at a lower one. Astray: lost, or where no
/// sensor can have moved to since the sweep before.
struct RateTrial {
  static constexpr int kTimesSlower = 5;

  double rate_hz = 0;      ///< assumed
  std::size_t sweeps = 0;  ///< 0: not tried
  std::size_t astray = 0;  ///< at that rate
  std::size_t slower_astray = 0;

  /// At most half as many go astray at the lower rate.
  bool slower() const { return sweeps > 0 && 2 * slower_astray <= astray; }
  /// What a user has to know of that; empty: nothing.
  std::string sentence() const;
};

/// Registers up to `most` sweeps from `start` on. Not tried where the data has stamps, or hardly a sweep goes astray at
/// the rate that was assumed.
RateTrial try_slower_rate(const OpenSource& open, std::size_t start, std::size_t most, const OdometryConfig& config,
                          const std::function<bool()>& interrupted);

/// A sentence about data without stamps of which several sweeps go astray, with what was tried. Empty: the data has
/// stamps, or they are few.
std::string doubtful_rate(const SourceInfo& info, const std::vector<SweepResult>& results, const RateTrial& trial);

}  // namespace rilo
