// Points that still carry their own instants.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Points in the sensor frame, each at its own instant. `offsets_s` (s, relative to the pose's reference instant) is as
/// long as `points`, or empty when the points share that instant. `counts` says how many measured points each is the
/// mean of; empty: one. `intensities` (sensor units): empty unless somebody wants them.
struct TimedCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> offsets_s = {};
  std::vector<float> counts = {};
  std::vector<float> intensities = {};

  std::size_t size() const { return points.size(); }
  bool timed() const { return !offsets_s.empty(); }
};

}  // namespace rilo
