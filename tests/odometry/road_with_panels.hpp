// A road between walls, and a sensor that comes along it.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "odometry/pose_search.hpp"
#include "odometry/registration_stage.hpp"

namespace rilo {

inline constexpr double kSearchPeriodS = 0.1;
inline constexpr std::int64_t kSearchPeriodNs = 100'000'000;

inline SE3 along(double x_m) { return SE3(Eigen::Translation3d(x_m, 0.0, 0.0)); }
inline double x_of(const Registration& found) { return found.icp.state.T_odom_lidar.translation().x(); }

/// Panels beside a road, left and right in turn: so far apart, and as far off that as makes them irregular.
struct Panels {
  double spacing_m = 5.0;
  double sway_m = 1.5;
};
inline constexpr Panels kIrregular;
inline constexpr Panels kRegular{2.5, 0.0};
inline constexpr Panels kNone{1000.0, 500.0};

/// A road between walls; panels show the way. Seen from `x_m` along it, sensor frame.
inline std::vector<Eigen::Vector3f> road(double x_m, double reach_m, double phase_m, double noise_m,
                                         const Panels& panels) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, noise_m + 1e-12);
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](double x, double y, double z) {
    const double dx = noise(rng);
    const double dy = noise(rng);
    points.push_back(Eigen::Vector3d(x - x_m + dx, y + dy, z + noise(rng)).cast<float>());
  };
  for (double x = std::floor(x_m - reach_m) + phase_m; x < x_m + reach_m; x += 0.3) {
    for (double y = -6.0 + phase_m; y < 6.0; y += 0.6) {
      add(x, y, -1.53);
    }
    for (double z = -1.5 + phase_m; z < 1.5; z += 0.3) {
      add(x, -6.03, z);
      add(x, 6.03, z);
    }
  }
  for (int i = -20; i <= 20; ++i) {
    const double panel = panels.spacing_m * i + panels.sway_m * std::sin(1.7 * i + 1.0);
    for (double y = -0.8 + phase_m; y < 0.8 && std::abs(panel - x_m) < reach_m; y += 0.1) {
      for (double z = -0.8 + phase_m; z < 0.8; z += 0.1) {
        add(panel, (i % 2 == 0 ? 4.0 : -4.0) + y, z);
      }
    }
  }
  return points;
}

/// A sensor that comes along that road at 10 m/s and is expected 1 m on.
class PoseSearches : public ::testing::Test {
 protected:
  void map_road(const Panels& panels) {
    LocalMapConfig config;
    config.range_noise_m = 0.0;
    config.angle_noise_rad = 0.0;
    map_ = SweepMap(config);
    const TimedCloud world{road(0.0, 40.0, 0.0, 0.0, panels)};
    map_.begin(world, {}, 8.0, {});
    map_.insert(world, {}, {});
    map_.insert(world, {}, {});
    tracker_.begin({along(-2.0)});
    for (const double x : {-1.0, 0.0}) {
      tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
      tracker_.accept(state_at(x), MotionVerdict::kPossible, false);
    }
    tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
    initial_pose_.keep_target({road(0.0, 20.0, 0.03, 0.01, panels)}, tracker_.trusted().twist);
  }

  static IcpResult state_at(double x) {
    IcpResult icp;
    icp.state.T_odom_lidar = along(x);
    icp.state.twist[3] = 10.0;
    icp.posterior_information.setIdentity();
    return icp;
  }

  void see_road(double x_m, const Panels& panels) {
    prepared_.source.points = prepared_.map_cloud.points = road(x_m, 20.0, 0.07, 0.01, panels);
    prepared_.scene_range_m = 8.0;
  }

  RegistrationContext context() {
    return {.config = config_,
            .prepared = prepared_,
            .tracker = tracker_,
            .map = map_,
            .initial_pose = initial_pose_,
            .pose_by_elevation = still_,
            .sigma_th_m = 0.1,
            .usual_sigma_th_m = 0.1,
            .period_s = kSearchPeriodS};
  }

  MotionState predicted() const { return tracker_.predicted(0.1); }

  Registration at_the_prediction(const RegistrationContext& parts) const {
    return PoseSearch(parts).to_map(predicted(), tracker_.prior(std::nullopt), 0.1, config_.icp, {});
  }

  OdometryConfig config_;
  PreparedSweep prepared_;
  MotionTracker tracker_{{}, {}, {}};
  SweepMap map_{LocalMapConfig{}};
  InitialPoseStage initial_pose_{{}, {}};
  PoseDerivative still_;
};

}  // namespace rilo
