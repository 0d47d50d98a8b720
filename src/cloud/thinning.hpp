// Some of the points of a sweep.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"
#include "rilo/cloud/sweep.hpp"

namespace rilo {

/// A share (0 … 1) of the points with their columns, in their order, evenly spread over it: over beams and columns of
/// the sensor, too, whatever the order. The same points for the same share.
/// @param kept holds the points.
/// @return view of `kept`.
SweepView thinned(const SweepView& sweep, double share, Sweep& kept);

/// The same of a cloud.
TimedCloud thinned(const TimedCloud& cloud, double share);

/// At most `count` points of `points`, evenly spread over their order.
std::vector<Eigen::Vector3f> evenly_picked(const std::vector<Eigen::Vector3f>& points, std::size_t count);

}  // namespace rilo
