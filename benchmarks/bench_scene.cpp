#include "bench_scene.hpp"

#include "cloud/deskew.hpp"

namespace rilo::bench {
namespace {

constexpr std::size_t kSweeps = 40;
constexpr double kDrivingS = 20;  // the vehicle is at full speed by then

std::vector<Eigen::Vector3f> compensated(const TimedCloud& cloud, const Vector6d& twist) {
  std::vector<Eigen::Vector3f> out;
  deskew(cloud, {twist}, out);
  return out;
}

}  // namespace

const std::vector<SimulatedSweep>& drive() {
  static const std::vector<SimulatedSweep> kDrive = [] {
    DriveConfig config;
    config.sweeps = kSweeps;
    config.start_s = kDrivingS;
    const DriveSimulator simulator(config);
    std::vector<SimulatedSweep> made;
    for (std::size_t i = 0; i < simulator.size(); ++i) {
      made.push_back(simulator.sweep(i));
    }
    return made;
  }();
  return kDrive;
}

OdometryConfig single_thread() {
  OdometryConfig config;
  config.threads = 1;
  return config;
}

Scene::Scene() : map(OdometryConfig().map) {
  const OdometryConfig config;
  Preprocessor preprocessor(config.preprocess);
  const std::vector<SimulatedSweep>& sweeps = drive();
  const double period_s = static_cast<double>(sweeps[1].sweep.stamp_ns - sweeps[0].sweep.stamp_ns) * 1e-9;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    before = last;
    last = preprocessor.prepare(sweeps[i].sweep);
    const SE3 previous = state.T_odom_lidar;
    state.T_odom_lidar = sweeps[i].T_odom_lidar_mid;
    T_before_last = previous.inverse() * state.T_odom_lidar;
    // Speeds change little from sweep to sweep: the motion since the last sweep is that during this one.
    state.twist = se3_log(i == 0 ? sweeps[1].T_odom_lidar_mid : T_before_last) / period_s;
    before_compensated = source_compensated;
    source_compensated = compensated(last.source, state.twist);
    map_compensated = compensated(last.map_cloud, state.twist);
    map.set_scene_range(last.scene_range_m);
    if (i + 1 < sweeps.size()) {
      map.insert(map_compensated, state.T_odom_lidar);
      map.evict(state.T_odom_lidar.translation());
    }
  }
}

const Scene& scene() {
  static const Scene kScene;
  return kScene;
}

}  // namespace rilo::bench
