// A tunnel: from some place on nothing shows how far the sensor moves.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"

namespace rilo {
namespace {

/// What a VLP-16 sees in a round tunnel, sensor frame: rings that move with it, and boxes on the ground up to a place.
class Tunnel {
 public:
  static constexpr double kForwardM = 0.35;
  static constexpr double kRadiusM = 3.0;
  static constexpr double kHeightM = 1.0;  // of the sensor over the ground
  static constexpr double kLastBoxM = 12.0;

  std::vector<Eigen::Vector3f> sweep(std::size_t index) {
    noise_.seed(static_cast<unsigned>(index));
    std::normal_distribution<double> error_m(0.0, 0.01);
    const double x_m = kForwardM * static_cast<double>(index);
    std::vector<Eigen::Vector3f> points;
    for (int beam = 0; beam < 16; ++beam) {
      const double elevation_rad = (2.0 * beam - 15.0) * std::numbers::pi / 180.0;
      for (int column = 0; column < 900; ++column) {
        const double azimuth_rad = 2.0 * std::numbers::pi * column / 900.0;
        const Eigen::Vector3d ray(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                  std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
        const double range_m = range(ray, x_m);
        if (range_m < 60.0) {
          points.push_back(((range_m + error_m(noise_)) * ray).cast<float>());
        }
      }
    }
    return points;
  }

 private:
  static double range(const Eigen::Vector3d& ray, double x_m) {
    double nearest_m = kRadiusM / ray.tail<2>().norm();
    if (ray.z() < 0.0) {
      nearest_m = std::min(nearest_m, -kHeightM / ray.z());
    }
    for (double box_m = -8.0; box_m <= kLastBoxM; box_m += 4.0) {
      const double to_face_m = (box_m - x_m) / ray.x();
      const Eigen::Vector3d hit = to_face_m * ray;
      const double side_m = std::abs(hit.y()) - 1.8;
      if (to_face_m > 0.0 && std::abs(side_m) < 0.5 && hit.z() < 0.2) {
        nearest_m = std::min(nearest_m, to_face_m);
      }
    }
    return nearest_m;
  }

  std::mt19937 noise_;
};

// No boxes any more: it moves on as before, wherever noise lets a sweep fit best.
TEST(InATunnel, WhereNothingShowsTheWayNoOtherPlaceIsTaken) {
  Tunnel tunnel;
  Odometry odometry({});
  double before_m = 0.0;
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i < 150; ++i) {
    const std::vector<Eigen::Vector3f> points = tunnel.sweep(i);
    SweepView view;
    view.points = points;
    view.stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
    const SweepResult result = odometry.register_sweep(view);
    const double x_m = result.T_odom_lidar.translation().x();
    if (i > 1) {
      EXPECT_NEAR(x_m - before_m, Tunnel::kForwardM, 0.1) << i << ' ' << to_string(result.status);
    }
    degenerate += result.status == OdometryStatus::kDegenerate;
    before_m = x_m;
  }
  EXPECT_GT(degenerate, 50U);
}

// A sweep is covered, and the next one found again: it leaves the way along the tunnel as open as those before.
TEST(InATunnel, WhatIsFoundAgainIsNoMoreCertainThanWhatIsSeen) {
  Tunnel tunnel;
  Odometry odometry({});
  double before_m2 = 0.0;
  for (std::size_t i = 0; i <= 101; ++i) {
    std::vector<Eigen::Vector3f> points = tunnel.sweep(i);
    for (Eigen::Vector3f& p : points) p *= i == 100 ? 0.2F : 1.0F;
    SweepView view;
    view.points = points;
    view.stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
    const SweepResult result = odometry.register_sweep(view);
    if (i == 99) {
      ASSERT_EQ(result.status, OdometryStatus::kDegenerate);
      before_m2 = result.covariance(4, 4);
    } else if (i == 101) {
      ASSERT_EQ(result.status, OdometryStatus::kRecovered) << to_string(result.stats.loss_cause);
      EXPECT_GT(result.covariance(4, 4), 0.5 * before_m2) << "across the tunnel";
    }
  }
}

}  // namespace
}  // namespace rilo
