// A sensor that turns: its turn rate belongs to the sweep, and is not always what the way to the sweep implies.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"

namespace rilo {
namespace {

constexpr double kPeriodS = 0.1;

/// Sweeps of a sensor in a room with a pillar, turning about its own axis: yaw = rate t + gain t² / 2 + sway sin 3π t.
class Turning {
 public:
  Turning(double rate, double gain, double sway = 0.0) : rate_(rate), gain_(gain), sway_(sway) {}

  double yaw(double t_s) const { return rate_ * t_s + 0.5 * gain_ * t_s * t_s + sway_ * std::sin(3.0 * M_PI * t_s); }
  /// At the middle of the sweep that begins at `t_s`, from that of the sweep at 0.
  double yaw_of_sweep(double t_s) const { return yaw(t_s + 0.5 * kPeriodS) - yaw(0.5 * kPeriodS); }

  /// 24 beams, 720 columns.
  Sweep sweep(double t_s, double stamp_s) const {
    Sweep sweep;
    sweep.stamp_ns = std::llround(stamp_s * 1e9);
    std::mt19937 generator(static_cast<unsigned>(1000.0 * t_s));
    std::normal_distribution<double> noise(0.0, 0.01);
    for (int column = 0; column < 720; ++column) {
      const double s = kPeriodS * column / 720.0;
      const double azimuth = -2.0 * M_PI * column / 720.0;
      const double heading = yaw(t_s + s) + azimuth;
      for (int beam = 0; beam < 24; ++beam) {
        const double elevation = -0.5 + 0.04 * beam;
        const Eigen::Vector3d ray(std::cos(elevation), 0.0, std::sin(elevation));
        const auto turned = [&ray](double a) -> Eigen::Vector3d {
          return Eigen::AngleAxisd(a, Eigen::Vector3d::UnitZ()) * ray;
        };
        const double range = range_along(turned(heading)) + noise(generator);
        sweep.points.emplace_back((range * turned(azimuth)).cast<float>());
        sweep.times_s.push_back(static_cast<float>(s));
      }
    }
    return sweep;
  }

 private:
  static double range_along(const Eigen::Vector3d& ray) {
    double range = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d high(6.0, 3.5, 1.4);
    const Eigen::Vector3d low(-4.0, -5.0, -1.2);
    for (int axis = 0; axis < 3; ++axis) {
      range = std::min(range, (ray[axis] > 0.0 ? high[axis] : low[axis]) / ray[axis]);
    }
    // The pillar, 0.8 m wide.
    const Eigen::Vector2d centre(2.5, 1.5);
    const Eigen::Vector2d flat = ray.head<2>();
    const double along = flat.dot(centre) / flat.squaredNorm();
    const double miss2 = (centre - along * flat).squaredNorm();
    if (along > 0.0 && miss2 < 0.16) {
      range = std::min(range, along - std::sqrt((0.16 - miss2) / flat.squaredNorm()));
    }
    return range;
  }

  double rate_;
  double gain_;
  double sway_;
};

double yaw_error(const SweepResult& result, double yaw) {
  return rotation_angle_rad(SE3(Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ())) * result.T_odom_lidar);
}

TEST(Turning, TheFirstSweepHasAVelocityOfItsOwn) {
  const Turning turning(1.5, -3.0);  // at 1.35 and -0.15 rad/s in the middles of the two sweeps
  Odometry odometry({});
  odometry.register_sweep(turning.sweep(0.0, 0.0));
  const SweepResult second = odometry.register_sweep(turning.sweep(0.5, 0.5));
  EXPECT_EQ(second.status, OdometryStatus::kOk);
  EXPECT_LT(yaw_error(second, turning.yaw_of_sweep(0.5)), 0.005);
  // At 3 rad/s² points of 0.1 s are off by 3 · 0.1² / 24 rad on average; a fifth of its square counts at first.
  EXPECT_GT(second.covariance(2, 2), 0.8 * 0.2 * std::pow(3.0 * 0.01 / 24.0, 2));
}

// A hand sways the sensor: up to 13 rad/s². At a constant velocity in each sweep the error is 0.0038 rad.
TEST(Turning, ASweepIsCompensatedForItsAcceleration) {
  const Turning turning(0.0, 0.0, 0.15);
  Odometry odometry({});
  double squares = 0.0;
  std::vector<double> rates;
  bool compensated_before = false;
  int compared = 0;
  constexpr int kSweeps = 30;
  for (int i = 0; i < kSweeps; ++i) {
    const SweepResult result = odometry.register_sweep(turning.sweep(kPeriodS * i, kPeriodS * i));
    squares += std::pow(yaw_error(result, turning.yaw_of_sweep(kPeriodS * i)), 2);
    rates.push_back(result.twist[2]);
    if (i > 2) {
      EXPECT_EQ(result.status, OdometryStatus::kOk) << i;
    }
    const bool compensated = result.acceleration[2] != 0.0;  // not where a search found it
    if (compensated && compensated_before) {
      const auto k = static_cast<std::size_t>(i);
      const double now = (rates[k] - rates[k - 1]) / kPeriodS;
      const double before = (rates[k - 1] - rates[k - 2]) / kPeriodS;
      EXPECT_NEAR(result.acceleration[2], now + 0.25 * (now - before), 1e-3) << "a quarter of its change goes on";
      ++compared;
    }
    compensated_before = compensated;
  }
  EXPECT_GT(compared, 5);
  EXPECT_LT(std::sqrt(squares / kSweeps), 0.0034);
}

TEST(Turning, ASweepOfAnotherTimeTurnsAsItsNeighboursDo) {
  for (const double rate : {0.6, 0.7, 0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.3, 1.4}) {
    const Turning turning(rate, 0.0);
    Odometry odometry({});
    for (int i = 0; i < 25; ++i) {
      const int taken = i >= 12 && i < 17 ? 28 - i : i;  // five in reverse order
      const SweepResult result = odometry.register_sweep(turning.sweep(kPeriodS * taken, kPeriodS * i));
      if (result.status != OdometryStatus::kLost) {
        EXPECT_LT(yaw_error(result, turning.yaw_of_sweep(kPeriodS * taken)), 0.01)
            << rate << " rad/s, sweep " << i << ' ' << to_string(result.status);
      }
    }
  }
}

}  // namespace
}  // namespace rilo
