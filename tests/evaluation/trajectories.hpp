// Trajectories whose errors are known by hand or by chance.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo::test {

inline SE3 pose(double x, double y, double z, double yaw_rad = 0.0) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp({0.0, 0.0, yaw_rad});
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

/// `n` poses along x, `step_m` apart.
inline std::vector<SE3> straight_line(std::size_t n, double step_m) {
  std::vector<SE3> poses;
  for (std::size_t i = 0; i < n; ++i) poses.push_back(pose(step_m * static_cast<double>(i), 0, 0));
  return poses;
}

inline Vector6d random_twist(std::mt19937& random, double rotation_rad, double translation_m) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi(i) = normal(random) * (i < 3 ? rotation_rad : translation_m);
  return xi;
}

/// A drive over `n` poses with wandering heading, about `step_m` a pose, starting anywhere.
inline std::vector<SE3> random_drive(std::mt19937& random, std::size_t n, double step_m) {
  std::vector<SE3> poses{se3_exp(random_twist(random, 1.0, 10.0))};
  Vector6d velocity = Vector6d::Zero();
  velocity(3) = step_m;
  while (poses.size() < n) {
    velocity.head<3>() = 0.95 * velocity.head<3>() + random_twist(random, 0.005, 0).head<3>();
    poses.push_back(renormalised(poses.back() * se3_exp(velocity)));
  }
  return poses;
}

/// The same drive with noise on every step, so that errors pile up as those of an odometry do.
inline std::vector<SE3> with_drift(std::mt19937& random, const std::vector<SE3>& truth, double rotation_rad,
                                   double translation_m) {
  std::vector<SE3> poses{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const SE3 step = truth[i - 1].inverse() * truth[i];
    poses.push_back(renormalised(poses.back() * step * se3_exp(random_twist(random, rotation_rad, translation_m))));
  }
  return poses;
}

}  // namespace rilo::test
