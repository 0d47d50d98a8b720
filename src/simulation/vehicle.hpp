// How the sensor rides on the vehicle.
#pragma once

#include "rilo/geometry/se3.hpp"
#include "simulation/drive_path.hpp"
#include "simulation/terrain.hpp"

namespace rilo::simulation {

/// Pose of the sensor at `t_s` (s): on the course, level with the ground between the wheels, pitching with the
/// acceleration along the course and rolling out of bends. C2 in time.
SE3 sensor_pose(const DrivePath& path, const Terrain& terrain, double mount_height_m, double t_s);

}  // namespace rilo::simulation
