// Input of the viewer.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "rilo/cloud/sweep.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// What is known before the first sweep.
struct ViewInfo {
  std::string title;                  ///< heading of the page
  std::string data;                   ///< what was read, UTF-8
  bool live = true;                   ///< false: a replay
  std::optional<std::size_t> sweeps;  ///< in all, when known
  double degenerate_ratio = 0;        ///< least relative eigenvalue of a sweep that counts as sound; 0: unknown
  double min_range_m = 0.5;           ///< points nearer than this are not shown
  double max_range_m = 100;           ///< nor are farther ones
  bool points = true;                 ///< sweeps come with points; false: trajectory and map alone
  std::string note;                   ///< a sentence for the user, such as why there are no points
};

/// One sweep.
struct ViewSweep {
  std::size_t index = 0;                 ///< place in the data
  SweepResult result;                    ///< a sweep registered, or as it was recorded
  std::optional<Eigen::Vector3d> truth;  ///< true position in the odometry frame (m)
  bool full_covariance = true;           ///< false: of result.covariance only the diagonal is known
  Sweep sweep;                           ///< as given to the odometry; without points: not shown
};

}  // namespace rilo
