// A drive that begins at speed: along a road the second sweep fits at rest, too.
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"

namespace rilo {
namespace {

constexpr double kStepM = 2.5;  // 90 km/h at 10 sweeps per second

/// Points of a motorway seen from `x_m` along it, sensor frame. Rings on the ground and on noise barriers are the same
/// in each sweep; panels at irregular distances show the way; backs of lorries drive with the sensor.
class Motorway {
 public:
  explicit Motorway(std::vector<double> lorries) : lorries_(std::move(lorries)) {}

  std::vector<Eigen::Vector3f> sweep(std::size_t index) {
    points_.clear();
    noise_.seed(static_cast<unsigned>(index));
    const double x_m = kStepM * static_cast<double>(index);
    for (double along = -40.0; along <= 40.0; along += 0.35) {
      for (double across = -9.0; across <= 9.0; across += 0.75) {
        add({along, across, -1.7});
      }
      for (double z = -1.7; z <= 1.0; z += 0.3) {
        add({along, -9.0, z});
        add({along, 9.0, z});
      }
    }
    for (const double lorry_m : lorries_) {
      board(lorry_m, lorry_m > 0.0 ? 3.5 : -3.5, 2.4, 0.12);
    }
    for (int i = -5; i < 26; ++i) {
      const double panel_m = 8.0 * i + 2.0 * std::sin(1.7 * i) - x_m;
      if (std::abs(panel_m) < 40.0) {
        board(panel_m, i % 2 == 0 ? 7.0 : -7.0, 1.8, 0.08);
      }
    }
    return points_;
  }

 private:
  void add(const Eigen::Vector3d& p) {
    std::normal_distribution<double> error(0.0, 0.01);
    points_.emplace_back(
        Eigen::Vector3d(p.x() + error(noise_), p.y() + error(noise_), p.z() + error(noise_)).cast<float>());
  }

  /// An upright square that faces along the road.
  void board(double x_m, double y_m, double size_m, double spacing_m) {
    for (double y = -0.5 * size_m; y <= 0.5 * size_m; y += spacing_m) {
      for (double z = 0.0; z <= size_m; z += spacing_m) {
        add({x_m, y_m + y, z - 1.5});
      }
    }
  }

  std::vector<double> lorries_;  // m ahead
  std::vector<Eigen::Vector3f> points_;
  std::mt19937 noise_;
};

void expect_found(Motorway motorway, const std::vector<std::size_t>& sweeps) {
  Odometry odometry({});
  for (const std::size_t i : sweeps) {
    const std::vector<Eigen::Vector3f> points = motorway.sweep(i);
    SweepView view;
    view.points = points;
    view.stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
    const SweepResult result = odometry.register_sweep(view);
    SCOPED_TRACE(testing::Message() << i << ' ' << to_string(result.status));
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), kStepM * static_cast<double>(i), 0.1);
  }
}

TEST(StartAtSpeed, TheSecondSweepIsNotTakenToStandStill) {
  expect_found(Motorway({-24.0, -15.0, 13.0, 24.0}), {0, 1, 2, 3, 4, 5, 6, 7});
}

// 7.5 and 10 m on: no start that suits a step of 0.1 s is near enough.
TEST(StartAtSpeed, TheSecondSweepIsSoughtAsFarAsTheTimeBetweenAllows) {
  expect_found(Motorway({}), {0, 3});
  expect_found(Motorway({}), {0, 4});
}

}  // namespace
}  // namespace rilo
