// Constant error of a spinning LiDAR's elevation angles.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "rilo/io/scan_source.hpp"

namespace rilo {

/// Adds `offset_deg` to the elevation angle of every point: a rotation about p × z, range and azimuth stay. Points on
/// the z axis have no such axis and stay.
void correct_elevation(std::vector<Eigen::Vector3f>& points, double offset_deg);

/// Applies correct_elevation to every sweep of `inner` and says so in info().
std::unique_ptr<ScanSource> with_elevation_correction(std::unique_ptr<ScanSource> inner, double offset_deg);

}  // namespace rilo
