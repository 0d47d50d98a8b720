// How well a pose explains the local map, and a search over poses by that measure.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "map/local_map.hpp"
#include "registration/deadline.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Mean over `points` (sensor frame) of exp(−e²/2σ²), e the distance to the map's plane at the point's place under
/// `T_odom_lidar`, in a voxel of `level` or a coarser one; a point without a plane counts 0. 0 … 1; 0 when there are no
/// points.
double map_score(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                 double sigma_m, std::size_t level = 0);

/// Whether the map shows `points` at `T_odom_lidar` rather than at one of four places a metre beside it: left, right,
/// front and back. What the pose explains and the place does not, in terms of map_score(), must be twice what the place
/// explains and the pose does not, or that be little. A registration finds a pose that fits a map of other places, too;
/// but then the places beside it fit as many other points. True where no point has a plane.
bool stands_out(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                double sigma_m);

/// At most `count` points of `points`, evenly spread over their order.
std::vector<Eigen::Vector3f> evenly_picked(const std::vector<Eigen::Vector3f>& points, std::size_t count);

/// Grid of poses around a centre: yaw about the sensor's own z axis, then shifts along its x and y axes.
struct PoseGrid {
  double max_shift_m = 4.0;
  double shift_step_m = 0.5;
  double max_yaw_rad = 0.0;
  double yaw_step_rad = 0.1;
};

/// The `keep` best poses of the grid around `centre` by map_score, best first, no two of them closer than two steps to
/// each other. After the deadline no further pose is scored; the nearest ones come first.
std::vector<SE3> search_poses(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& centre,
                              const PoseGrid& grid, double sigma_m, std::size_t keep, const Deadline& deadline = {});

}  // namespace rilo
