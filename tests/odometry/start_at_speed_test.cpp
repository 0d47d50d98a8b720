// At speed along a road: the second sweep fits at rest, too, and a sweep of another moment where it was not taken.
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"

namespace rilo {
namespace {

constexpr double kStepM = 2.5;  // 90 km/h at 10 sweeps per second
constexpr double kReachM = 40.0;

struct Panels {
  double size_m = 1.8;
  double until_m = 1e3;
};

/// Points of a motorway seen from `x_m` along it, sensor frame. Rings on the ground and on noise barriers are the same
/// in each sweep; panels at irregular distances show the way; backs of lorries drive with the sensor.
class Motorway {
 public:
  explicit Motorway(std::vector<double> lorries, const Panels& panels = {})
      : lorries_(std::move(lorries)), panels_(panels) {}

  std::vector<Eigen::Vector3f> sweep(std::size_t index) {
    points_.clear();
    noise_.seed(static_cast<unsigned>(index));
    const double x_m = kStepM * static_cast<double>(index);
    for (double along = -kReachM; along <= kReachM; along += 0.35) {
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
    const int last = static_cast<int>((x_m + kReachM) / 8.0);
    for (int i = -5; i <= last; ++i) {
      const double panel_m = 8.0 * i + 2.0 * std::sin(1.7 * i) - x_m;
      if (std::abs(panel_m) < kReachM && panel_m + x_m < panels_.until_m) {
        board(panel_m, i % 2 == 0 ? 7.0 : -7.0, panels_.size_m, 0.08);
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
  Panels panels_;
  std::vector<Eigen::Vector3f> points_;
  std::mt19937 noise_;
};

SweepResult registered(Odometry& odometry, const std::vector<Eigen::Vector3f>& points, std::size_t stamped) {
  SweepView view;
  view.points = points;
  view.stamp_ns = static_cast<std::int64_t>(stamped) * 100'000'000;
  return odometry.register_sweep(view);
}

void expect_found(Motorway motorway, const std::vector<std::size_t>& sweeps) {
  Odometry odometry({});
  for (const std::size_t i : sweeps) {
    const SweepResult result = registered(odometry, motorway.sweep(i), i);
    SCOPED_TRACE(testing::Message() << i << ' ' << to_string(result.status));
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), kStepM * static_cast<double>(i), 0.1);
  }
}

struct Faulty {
  std::size_t taken = 0;    // when it was, ...
  std::size_t stamped = 0;  // ... and when it says it was
};

/// Poses that are vouched for are right; how many of the sweeps are.
std::size_t vouched_and_right(Motorway motorway, const std::vector<Faulty>& sweeps) {
  Odometry odometry({});
  std::size_t vouched = 0;
  double anchor_m = 0.0;
  for (const Faulty& sweep : sweeps) {
    const SweepResult result = registered(odometry, motorway.sweep(sweep.taken), sweep.stamped);
    const double truth_m = kStepM * static_cast<double>(sweep.taken);
    const double found_m = result.T_odom_lidar.translation().x();
    if (result.status == OdometryStatus::kInitialising) {
      anchor_m = found_m - truth_m;
    } else if (result.status != OdometryStatus::kLost) {
      ++vouched;
      EXPECT_NEAR(found_m - anchor_m, truth_m, 0.25) << sweep.stamped << ' ' << to_string(result.status);
    }
  }
  return vouched;
}

TEST(StartAtSpeed, TheSecondSweepIsNotTakenToStandStill) {
  expect_found(Motorway({-24.0, -15.0, 13.0, 24.0}), {0, 1, 2, 3, 4, 5, 6, 7});
}

// 7.5 and 10 m on: no start that suits a step of 0.1 s is near enough.
TEST(StartAtSpeed, TheSecondSweepIsSoughtAsFarAsTheTimeBetweenAllows) {
  expect_found(Motorway({}), {0, 3});
  expect_found(Motorway({}), {0, 4});
}

// Nothing shows the way: each sweep begins a new map, which does not inherit the doubt about the last.
TEST(StartAtSpeed, ANewMapBeginsWithTheUsualGate) {
  Motorway motorway({}, {.size_m = 0.0});
  Odometry odometry({});
  for (std::size_t i = 0; i < 5; ++i) {
    const SweepResult result = registered(odometry, motorway.sweep(i), i);
    EXPECT_EQ(result.status, OdometryStatus::kInitialising) << i;
    if (i > 0) {
      EXPECT_DOUBLE_EQ(result.stats.sigma_th_m, OdometryConfig().threshold.initial_m) << i;
    }
  }
}

// The score of the pavement hides that of a few small panels.
TEST(AtSpeed, SweepsOfAnotherMomentAreFoundWhereTheyWereTaken) {
  std::vector<Faulty> sweeps;
  for (std::size_t i = 0; i < 22; ++i) {
    sweeps.push_back({i, i});
  }
  std::vector<Faulty> swapped = sweeps;
  std::swap(swapped[10].taken, swapped[11].taken);
  std::vector<Faulty> reversed = sweeps;
  for (std::size_t i = 0; i < 5; ++i) {
    reversed[10 + i].taken = 14 - i;
  }
  for (const double size_m : {1.8, 1.0}) {
    const Motorway motorway({}, {.size_m = size_m});
    EXPECT_GE(vouched_and_right(motorway, swapped), 18U) << size_m;
    EXPECT_GE(vouched_and_right(motorway, reversed), 16U) << size_m;
  }
}

// No panels any more: it moves on as before, wherever noise lets a sweep fit best.
TEST(AtSpeed, WhereNothingShowsTheWayNoOtherPlaceIsTaken) {
  std::vector<Faulty> sweeps;
  for (std::size_t i = 0; i < 50; ++i) {
    sweeps.push_back({i, i});
  }
  EXPECT_GE(vouched_and_right(Motorway({}, {.until_m = 20.0}), sweeps), 45U);
}

}  // namespace
}  // namespace rilo
