// At speed along a road: the second sweep fits at rest, too, and a sweep of another moment where it was not taken.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"

namespace rilo {
namespace {

constexpr double kStepM = 2.5;  // 90 km/h at 10 sweeps per second
constexpr double kReachM = 40.0;

/// Points of a motorway seen from `x_m` along it, sensor frame. Rings on the ground and on noise barriers are the same
/// in each sweep; panels at irregular distances and bushes show the way; backs of lorries drive with the sensor.
class Motorway {
 public:
  explicit Motorway(std::vector<double> lorries, double panel_size_m = 1.8, bool bushes = false, double step_m = kStepM)
      : lorries_(std::move(lorries)), panel_size_m_(panel_size_m), bushes_(bushes), step_m_(step_m) {}

  double step_m() const { return step_m_; }
  /// From now on the sensor sees so much to either side of straight ahead alone, and there are no barriers.
  void look_ahead(double half_window_rad) {
    half_window_rad_ = half_window_rad;
    barriers_ = false;
  }

  /// `run`: of the noise.
  std::vector<Eigen::Vector3f> sweep(std::size_t index, unsigned run = 0) {
    points_.clear();
    noise_.seed(1000 * run + static_cast<unsigned>(index));
    const double x_m = step_m_ * static_cast<double>(index);
    for (double along = -kReachM; along <= kReachM; along += 0.35) {
      for (double across = -9.0; across <= 9.0; across += 0.75) {
        add({along, across, -1.7});
      }
      for (double z = -1.7; barriers_ && z <= 1.0; z += 0.3) {
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
      if (std::abs(panel_m) < kReachM) {
        board(panel_m, i % 2 == 0 ? 7.0 : -7.0, panel_size_m_, 0.08);
      }
    }
    for (int i = -20; bushes_ && i <= static_cast<int>(x_m + kReachM) / 2; ++i) {
      bush(2.0 * i - x_m, i);
    }
    return points_;
  }

 private:
  void add(const Eigen::Vector3d& p) {
    std::normal_distribution<double> error(0.0, 0.01);
    Eigen::Vector3d seen = p;
    for (double& coordinate : seen) {  // in this order with any compiler
      coordinate += error(noise_);
    }
    if (std::abs(std::atan2(seen.y(), seen.x())) <= half_window_rad_) {
      points_.push_back(seen.cast<float>());
    }
  }

  /// An upright square that faces along the road.
  void board(double x_m, double y_m, double size_m, double spacing_m) {
    for (double y = -0.5 * size_m; y <= 0.5 * size_m; y += spacing_m) {
      for (double z = 0.0; z <= size_m; z += spacing_m) {
        add({x_m, y_m + y, z - 1.5});
      }
    }
  }

  /// A few twigs on the barrier, the same in each sweep that sees them.
  void bush(double x_m, int number) {
    std::mt19937 twigs(static_cast<unsigned>(number + 100));
    std::uniform_real_distribution<double> place(-0.5, 0.5);
    for (int i = 0; i < 80 && std::abs(x_m) < kReachM; ++i) {
      const double side = number % 2 == 0 ? 10.0 : -10.0;
      const double x = x_m + place(twigs);
      const double y = side + place(twigs);
      add({x, y, 1.5 + place(twigs)});
    }
  }

  std::vector<double> lorries_;  // m ahead
  double panel_size_m_;
  bool bushes_;
  double step_m_;  // from sweep to sweep
  double half_window_rad_ = std::numbers::pi;
  bool barriers_ = true;
  std::vector<Eigen::Vector3f> points_;
  std::mt19937 noise_;
};

SweepResult registered(Odometry& odometry, const std::vector<Eigen::Vector3f>& points, std::size_t stamped,
                       std::int64_t late_ms = 0) {
  SweepView view;
  view.points = points;
  view.stamp_ns = static_cast<std::int64_t>(stamped) * 100'000'000 + late_ms * 1'000'000;
  return odometry.register_sweep(view);
}

void expect_found(Motorway motorway, const std::vector<std::size_t>& sweeps) {
  for (unsigned run = 0; run < 3; ++run) {
    Odometry odometry({});
    for (const std::size_t i : sweeps) {
      const SweepResult result = registered(odometry, motorway.sweep(i, run), i);
      SCOPED_TRACE(testing::Message() << run << ' ' << i << ' ' << to_string(result.status));
      EXPECT_NEAR(result.T_odom_lidar.translation().x(), motorway.step_m() * static_cast<double>(i), 0.1);
    }
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
  expect_found(Motorway({-15.0, 13.0, 24.0}), {0, 1, 2, 3, 4, 5, 6, 7});
}

// As much drives with the sensor as stands: which of the two it is, is chance.
TEST(StartAtSpeed, AmongAsManyLorriesAsPanelsAWrongSecondSweepIsNotVouchedFor) {
  Motorway motorway({-24.0, -15.0, 13.0, 24.0});
  for (unsigned run = 0; run < 20; ++run) {
    Odometry odometry({});
    registered(odometry, motorway.sweep(0, run), 0);
    const SweepResult second = registered(odometry, motorway.sweep(1, run), 1);
    EXPECT_TRUE(second.status == OdometryStatus::kInitialising ||
                std::abs(second.T_odom_lidar.translation().x() - kStepM) < 0.1)
        << run;
  }
}

// Most of what is seen drives with the sensor: more than chance explains, and yet no reason to stand still.
TEST(StartAtSpeed, AConvoyIsNotTakenForTheWorld) {
  Motorway motorway({-31.0, -26.0, -21.0, -16.0, 16.0, 21.0, 26.0, 31.0});
  for (unsigned run = 0; run < 10; ++run) {
    Odometry odometry({});
    registered(odometry, motorway.sweep(0, run), 0);
    const SweepResult second = registered(odometry, motorway.sweep(1, run), 1);
    EXPECT_EQ(second.status, OdometryStatus::kInitialising) << run << ' ' << second.T_odom_lidar.translation().x();
  }
}

// A registration weights what it sees densely: the lorries. What is spread over the surroundings decides.
TEST(StartAtSpeed, TheSecondSweepIsNotTakenToStandStillAmongLorriesOfItsPace) {
  expect_found(Motorway({-24.0, -15.0, 13.0, 24.0}, 0.3, true), {0, 1, 2, 3, 4, 5, 6, 7});
}

// At 4 and 5 m/s the true place lies beside the one at rest: the gate of a registration takes in both.
TEST(StartAtSpeed, NorWhereItHasHardlyMoved) {
  for (const double step_m : {0.4, 0.5}) {
    SCOPED_TRACE(step_m);
    expect_found(Motorway({13.0, 24.0}, 1.0, true, step_m), {0, 1, 2, 3});
  }
}

// Ahead there are lorries of its pace, and little that shows a motion to the side: that is not the way, though it is
// constrained least.
TEST(StartAtSpeed, NorInANarrowWindow) {
  for (const double step_m : {0.9, 2.5}) {
    SCOPED_TRACE(step_m);
    Motorway motorway({13.0, 24.0}, 1.0, true, step_m);
    motorway.look_ahead(0.6);
    expect_found(motorway, {0, 1, 2, 3});
  }
}

// 7.5 and 10 m on: no start that suits a step of 0.1 s is near enough.
TEST(StartAtSpeed, TheSecondSweepIsSoughtAsFarAsTheTimeBetweenAllows) {
  expect_found(Motorway({}), {0, 3});
  expect_found(Motorway({}), {0, 4});
}

// Nothing shows the way: each sweep begins a new map, which does not inherit the doubt about the last.
TEST(StartAtSpeed, ANewMapBeginsWithTheUsualGate) {
  Motorway motorway({}, 0.0);
  Odometry odometry({});
  for (std::size_t i = 0; i < 5; ++i) {
    const SweepResult result = registered(odometry, motorway.sweep(i), i);
    EXPECT_EQ(result.status, OdometryStatus::kInitialising) << i;
    if (i > 0) {
      EXPECT_DOUBLE_EQ(result.stats.sigma_th_m, OdometryConfig().threshold.initial_m) << i;
    }
  }
}

// What two sweeps alone do not tell is known from a pass before: the map begins with the first sweep.
TEST(StartAtSpeed, AKnownVelocityTellsWhatTwoSweepsDoNot) {
  Motorway motorway({-24.0, -15.0, 13.0, 24.0});
  KnownVelocity known{Vector6d::Zero(), 0.5};
  known.twist[3] = 10.0 * kStepM + 0.5;
  int not_vouched = 0;
  for (unsigned run = 0; run < 10; ++run) {
    Odometry unknown({});
    registered(unknown, motorway.sweep(0, run), 0);
    not_vouched += registered(unknown, motorway.sweep(1, run), 1).status == OdometryStatus::kInitialising ? 1 : 0;
    Odometry odometry({});
    odometry.start_over(known);
    for (std::size_t i = 0; i < 6; ++i) {
      const SweepResult result = registered(odometry, motorway.sweep(i, run), i);
      EXPECT_EQ(result.status, i == 0 ? OdometryStatus::kInitialising : OdometryStatus::kOk) << run << ' ' << i;
      EXPECT_TRUE(i != 1 || !result.stats.coarse_ran) << "no doubt, no search";
      EXPECT_NEAR(result.T_odom_lidar.translation().x(), kStepM * static_cast<double>(i), 0.1) << run << ' ' << i;
    }
  }
  EXPECT_GE(not_vouched, 5);
}

// A driver begins in the middle of a turn of the sensor.
TEST(StartAtSpeed, PartOfAFirstSweepDoesNotDrawTheSecondAway) {
  Motorway motorway({13.0}, 1.8, true, 0.5);
  for (unsigned run = 0; run < 5; ++run) {
    std::vector<Eigen::Vector3f> part = motorway.sweep(0, run);
    std::erase_if(part, [](const Eigen::Vector3f& p) { return std::abs(std::atan2(p.y(), p.x()) - 1.5F) > 0.2F; });
    Odometry odometry({});
    registered(odometry, part, 0);
    const SweepResult second = registered(odometry, motorway.sweep(1, run), 1);
    EXPECT_LT(second.T_odom_lidar.translation().norm(), 1.0) << run << ' ' << to_string(second.status);
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
    const Motorway motorway({}, size_m);
    EXPECT_GE(vouched_and_right(motorway, swapped), 18U) << size_m;
    EXPECT_GE(vouched_and_right(motorway, reversed), 16U) << size_m;
  }
}

// At 25 m/s a sweep stamped 24 ms late seems to be 0.6 m farther on, and a few small panels do not outweigh that.
TEST(AtSpeed, StampsOfArrivalDoNotMoveTheSensor) {
  Motorway motorway({}, 0.8);
  Odometry odometry({});
  std::mt19937 rng(3);
  std::uniform_int_distribution<std::int64_t> late_ms(0, 24);
  double before_m = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    const SweepResult result = registered(odometry, motorway.sweep(i), i, late_ms(rng));
    const double x_m = result.T_odom_lidar.translation().x();
    if (i > 5) {
      EXPECT_NEAR(x_m - before_m, kStepM, 0.1) << i << ' ' << to_string(result.status);
    }
    before_m = x_m;
  }
}

}  // namespace
}  // namespace rilo
