// Faults of the data, put into a simulated drive: no pose that the status vouches for is wrong, and tracking goes on.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

struct Recorded {
  Sweep sweep;
  SE3 truth;
};

const std::vector<Recorded>& drive() {
  static const std::vector<Recorded> kRecorded = [] {
    DriveConfig config;
    config.sensor = SensorKind::kVlp16;
    config.sweeps = 40;
    config.start_s = 4.0;
    const DriveSimulator simulator(config);
    std::vector<Recorded> sweeps;
    for (std::size_t i = 0; i < simulator.size(); ++i) {
      SimulatedSweep s = simulator.sweep(i);
      sweeps.push_back({std::move(s.sweep), s.T_odom_lidar_mid});
    }
    return sweeps;
  }();
  return kRecorded;
}

constexpr std::size_t kMiddle = 20;

/// Wrong by more than 0.25 m or 2° since the map began and vouched for: so many. The last five poses must be vouched
/// for.
std::size_t wrong_poses(const std::vector<Recorded>& sweeps) {
  Odometry odometry({});
  std::optional<std::pair<SE3, SE3>> anchor;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const SweepResult result = odometry.register_sweep(sweeps[i].sweep);
    if (result.status == OdometryStatus::kInitialising) {
      anchor = {result.T_odom_lidar, sweeps[i].truth};
    }
    const bool vouched = result.status != OdometryStatus::kInitialising && result.status != OdometryStatus::kLost &&
                         result.status != OdometryStatus::kEmpty;
    if (i + 5 >= sweeps.size()) {
      EXPECT_TRUE(vouched) << i << ' ' << to_string(result.status);
    }
    if (!vouched || !anchor) {
      continue;
    }
    const SE3 found = anchor->first.inverse() * result.T_odom_lidar;
    const SE3 error = (anchor->second.inverse() * sweeps[i].truth).inverse() * found;
    wrong += error.translation().norm() > 0.25 || rotation_angle_rad(error) > 0.035 ? 1U : 0U;
  }
  return wrong;
}

/// The data of `other` at the time of `at`.
Recorded data_at(const Recorded& at, const Recorded& other) {
  Recorded moved = other;
  moved.sweep.stamp_ns = at.sweep.stamp_ns;
  return moved;
}

Recorded of_elsewhere(const Recorded& at) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = 1;
  config.start_s = 60.0;
  Recorded strange{DriveSimulator(config).sweep(0).sweep, at.truth};
  strange.sweep.stamp_ns = at.sweep.stamp_ns;
  // Nothing of it is where it could be.
  for (Eigen::Vector3f& p : strange.sweep.points) {
    p = Eigen::Vector3f(0.7F * p.y() + 3.0F, p.z() + 5.0F, 0.5F * p.x());
  }
  return strange;
}

TEST(Faults, NoneGivesNone) { EXPECT_EQ(wrong_poses(drive()), 0U); }

TEST(Faults, SecondSweepFromElsewhere) {
  std::vector<Recorded> sweeps = drive();
  sweeps[1] = of_elsewhere(sweeps[1]);
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

// What is empty says nothing against the map: the next sweeps are registered within the usual gate.
TEST(Faults, EmptySweepsAfterTheFirstDoNotWidenTheGateOfTheNext) {
  Odometry odometry({});
  const double usual_m = OdometryConfig().threshold.initial_m;
  for (std::size_t i = 0; i < 7; ++i) {
    const SweepView view = drive()[i].sweep;
    SweepView empty;
    empty.stamp_ns = view.stamp_ns;
    const SweepResult result = odometry.register_sweep(i >= 1 && i <= 3 ? empty : view);
    if (i > 4) {
      EXPECT_LE(result.stats.sigma_th_m, usual_m) << i;
    }
  }
}

TEST(Faults, GapAfterTheFirstSweep) {
  std::vector<Recorded> sweeps = drive();
  sweeps.erase(sweeps.begin() + 1, sweeps.begin() + 11);
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, GapWithoutStamps) {
  std::vector<Recorded> sweeps = drive();
  const std::int64_t missing = sweeps[kMiddle + 6].sweep.stamp_ns - sweeps[kMiddle].sweep.stamp_ns;
  sweeps.erase(sweeps.begin() + kMiddle, sweeps.begin() + kMiddle + 6);
  for (std::size_t i = kMiddle; i < sweeps.size(); ++i) {
    sweeps[i].sweep.stamp_ns -= missing;
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, SweepsSwapped) {
  std::vector<Recorded> sweeps = drive();
  sweeps[kMiddle] = data_at(drive()[kMiddle], drive()[kMiddle + 1]);
  sweeps[kMiddle + 1] = data_at(drive()[kMiddle + 1], drive()[kMiddle]);
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, SweepsReversed) {
  std::vector<Recorded> sweeps = drive();
  for (std::size_t i = 0; i < 5; ++i) {
    sweeps[kMiddle + i] = data_at(drive()[kMiddle + i], drive()[kMiddle + 4 - i]);
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, OneStampAheadAndAClockThatWasSet) {
  std::vector<Recorded> sweeps = drive();
  sweeps[kMiddle].sweep.stamp_ns += 1'000'000'000'000;
  EXPECT_EQ(wrong_poses(sweeps), 0U);
  sweeps = drive();
  for (std::size_t i = kMiddle; i < sweeps.size(); ++i) {
    sweeps[i].sweep.stamp_ns += 100'000'000'000;
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, FrozenDriver) {
  std::vector<Recorded> sweeps = drive();
  for (std::size_t i = kMiddle + 1; i < kMiddle + 5; ++i) {
    sweeps[i] = data_at(sweeps[i], sweeps[kMiddle]);
  }
  Odometry odometry({});
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const OdometryStatus status = odometry.register_sweep(sweeps[i].sweep).status;
    EXPECT_EQ(status == OdometryStatus::kEmpty, i > kMiddle && i < kMiddle + 5) << i << ' ' << to_string(status);
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, ASensorWithoutNoiseThatStopsStaysWhereItIs) {
  std::vector<Recorded> sweeps(drive().begin(), drive().begin() + kMiddle);
  const Recorded last = sweeps.back();
  for (std::size_t i = kMiddle; i < 2 * kMiddle; ++i) {
    sweeps.push_back(data_at(drive()[i], last));
  }
  const std::int64_t stood_ns = sweeps.back().sweep.stamp_ns - last.sweep.stamp_ns;
  for (std::size_t i = kMiddle; i < 2 * kMiddle; ++i) {
    sweeps.push_back(drive()[i]);
    sweeps.back().sweep.stamp_ns += stood_ns;
  }
  Odometry odometry({});
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const SweepResult result = odometry.register_sweep(sweeps[i].sweep);
    const bool again = i >= kMiddle && i < 2 * kMiddle;
    EXPECT_EQ(result.status == OdometryStatus::kEmpty, again) << i << ' ' << to_string(result.status);
    const SE3 error = (sweeps[0].truth.inverse() * sweeps[i].truth).inverse() * result.T_odom_lidar;
    EXPECT_LT(error.translation().norm(), 0.1) << i;
    EXPECT_TRUE(!again || result.twist.isZero()) << i;
  }
}

TEST(Faults, SensorCovered) {
  std::vector<Recorded> sweeps = drive();
  for (std::size_t i = kMiddle; i < kMiddle + 8; ++i) {
    for (Eigen::Vector3f& p : sweeps[i].sweep.points) {
      p *= 1.5F / std::max(p.norm(), 0.1F);
    }
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, ForeignSweepAndHalfASweep) {
  std::vector<Recorded> sweeps = drive();
  sweeps[kMiddle] = of_elsewhere(sweeps[kMiddle]);
  EXPECT_EQ(wrong_poses(sweeps), 0U);
  sweeps = drive();
  Sweep& half = sweeps[kMiddle].sweep;
  half.points.resize(half.points.size() / 2);
  half.times_s.resize(half.times_s.size() / 2);
  half.intensities.resize(half.intensities.size() / 2);
  half.rings.resize(half.rings.size() / 2);
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

TEST(Faults, TimesInAnotherUnitLeaveNothing) {
  for (const float factor : {1e3F, 1e6F, 1e9F}) {
    Odometry odometry({});
    for (const std::size_t i : {0U, 1U, 2U}) {
      Sweep sweep = drive()[i].sweep;
      for (float& time : sweep.times_s) {
        time *= factor;
      }
      EXPECT_EQ(odometry.register_sweep(sweep).status, OdometryStatus::kEmpty) << factor;
    }
  }
}

// The caller's mistake: a column that was dropped would cost the motion compensation, with status ok.
TEST(Faults, AColumnOfAnotherLengthIsRefusedAndNothingIsRegistered) {
  Odometry odometry(OdometryConfig{});
  odometry.register_sweep(drive()[0].sweep);
  for (auto cut : {+[](Sweep& s) { s.times_s.pop_back(); }, +[](Sweep& s) { s.intensities.assign(3, 0.0F); },
                   +[](Sweep& s) { s.rings.assign(s.points.size() + 1, 0); }}) {
    Sweep sweep = drive()[1].sweep;
    cut(sweep);
    EXPECT_THROW(odometry.register_sweep(sweep), std::invalid_argument);
  }
  EXPECT_EQ(odometry.trajectory().size(), 1U);
  EXPECT_EQ(odometry.register_sweep(drive()[1].sweep).status, OdometryStatus::kOk);
}

TEST(Faults, SingleTimesThatAreNoneOfTheSweep) {
  std::vector<Recorded> sweeps = drive();
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    sweeps[i].sweep.times_s[100 * i] = 1e5F;
  }
  EXPECT_EQ(wrong_poses(sweeps), 0U);
}

}  // namespace
}  // namespace rilo
