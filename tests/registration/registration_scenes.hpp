// Scenes and comparisons shared by the tests of the registration.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"

namespace rilo::test {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;

/// A map of points without noise: exact planes count in full.
inline LocalMapConfig exact_map_config() {
  LocalMapConfig config;
  config.range_noise_m = 0.0;
  config.angle_noise_rad = 0.0;
  config.scatter_voxel_m = 0.0;
  return config;
}

/// The voxels that the scenes are made for.
inline LocalMapConfig scene_map_config() {
  LocalMapConfig config = exact_map_config();
  config.voxel_m = 0.25;
  return config;
}

inline Vector6d twist(double rx, double ry, double rz, double x, double y, double z) {
  Vector6d xi;
  xi << rx, ry, rz, x, y, z;
  return xi;
}

/// Lattices on the six faces of a box around the origin, ending `rim_m` before the edges: no voxel sees two faces, so
/// that every plane of a map made of them is exact. World frame.
inline std::vector<Eigen::Vector3d> rimless_room(double spacing_m, double phase, double rim_m = 1.0) {
  const Eigen::Vector3d half(6.13, 4.61, 2.87);
  std::vector<Eigen::Vector3d> points;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (double u = -half[a] + rim_m + phase * spacing_m; u < half[a] - rim_m; u += spacing_m) {
        for (double v = -half[b] + rim_m + phase * spacing_m; v < half[b] - rim_m; v += spacing_m) {
          Eigen::Vector3d p;
          p[axis] = side * half[axis];
          p[a] = u;
          p[b] = v;
          points.push_back(p);
        }
      }
    }
  }
  return points;
}

inline std::vector<Eigen::Vector3f> seen_from(const SE3& T_world_sensor, const std::vector<Eigen::Vector3d>& world) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(world.size());
  for (const Eigen::Vector3d& p : world) {
    points.push_back((T_world_sensor.inverse() * p).cast<float>());
  }
  return points;
}

/// A map of one fine level and its parent.
inline LocalMap map_of(const std::vector<Eigen::Vector3d>& world) {
  LocalMapConfig config = exact_map_config();
  config.voxel_m = 0.5;
  config.levels = 2;
  LocalMap map(config);
  map.set_scene_range(6.0);
  map.insert(seen_from(SE3::Identity(), world), SE3::Identity());
  return map;
}

/// What a sensor moving with `velocity` (body, at the reference instant) measures of `points` within ±0.05 s.
inline TimedCloud measured_in_motion(const std::vector<Eigen::Vector3f>& points, const Vector6d& velocity) {
  TimedCloud cloud;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double offset_s = -0.05 + 0.1 * static_cast<double>((i * 7919) % n) / static_cast<double>(n);
    const SE3 T = se3_exp(velocity * offset_s);
    cloud.points.push_back((T.inverse() * points[i].cast<double>()).cast<float>());
    cloud.offsets_s.push_back(static_cast<float>(offset_s));
  }
  return cloud;
}

inline double distance_m(const SE3& a, const SE3& b) { return (a.inverse() * b).translation().norm(); }
inline double angle_deg(const SE3& a, const SE3& b) { return rotation_angle_rad(a.inverse() * b) / kDegree; }

}  // namespace rilo::test
