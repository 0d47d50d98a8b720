// Points with their own times.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Points in the sensor frame, each at its own time. `offsets_s` (s, relative to the pose's reference time) is as
/// long as `points`, or empty when the points share that time. `counts` says how many measured points each is the
/// mean of; empty: one. `intensities` (sensor units): empty unless they are wanted.
struct TimedCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> offsets_s = {};
  std::vector<float> counts = {};
  std::vector<float> intensities = {};

  std::size_t size() const { return points.size(); }
  bool timed() const { return !offsets_s.empty(); }
};

}  // namespace rilo
