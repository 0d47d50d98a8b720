#include "rilo/simulation/drive_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include "cloud/fixed_chunks.hpp"
#include "geometry/degrees.hpp"
#include "simulation/counter_random.hpp"
#include "simulation/drive_path.hpp"
#include "simulation/town.hpp"
#include "simulation/traffic.hpp"
#include "simulation/vehicle.hpp"

namespace rilo {
namespace {

using simulation::Hit;
using simulation::Ray;

constexpr double kNanoseconds = 1e9;
constexpr double kOverlapM = 50;        // of a whole lap's drive with its beginning
constexpr double kGlassAnswers = 0.45;  // share of the panes' returns; the others go through and are lost
constexpr double kIntensityNoise = 0.03;
// A surface answers while reflectivity * cos(incidence) exceeds this at the sensor's longest range (goes with r²):
// asphalt fades out near 60 m, walls do not.
constexpr double kFaintest = 0.02;

DriveConfig checked(DriveConfig config) {
  config.validate();
  return config;
}

// The last time that is asked for. Without a number of sweeps the path is made for a lap at walking pace.
double path_end_s(const DriveConfig& config, const SensorModel& sensor) {
  constexpr double kLongestLapS = 400;
  const double driven_s = config.sweeps > 0 ? static_cast<double>(config.sweeps) * sensor.period_s : kLongestLapS;
  return config.start_s + driven_s;
}

std::size_t sweeps_of_a_lap(const DriveConfig& config, const SensorModel& sensor, const DrivePath& path) {
  const double goal_m = path.distance_m(config.start_s) + path.lap_m() + kOverlapM;
  std::size_t sweeps = 1;
  while (path.distance_m(config.start_s + static_cast<double>(sweeps) * sensor.period_s) < goal_m) ++sweeps;
  return sweeps;
}

Eigen::Vector3d direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

void append(Sweep& all, Sweep&& part) {
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  all.times_s.insert(all.times_s.end(), part.times_s.begin(), part.times_s.end());
  all.intensities.insert(all.intensities.end(), part.intensities.begin(), part.intensities.end());
  all.rings.insert(all.rings.end(), part.rings.begin(), part.rings.end());
}

}  // namespace

struct DriveSimulator::Impl {
  explicit Impl(const DriveConfig& given);

  SE3 pose_at(double t_s) const {
    return simulation::sensor_pose(path_, town_.terrain(), sensor_.mount_height_m, config_.start_s + t_s);
  }
  Sweep cast_columns(std::size_t sweep, std::size_t begin, std::size_t end, const SE3& T_mid_world) const;
  void cast_column(std::size_t sweep, std::size_t column, const SE3& T_mid_world, Sweep& out) const;

  DriveConfig config_;
  SensorModel sensor_;
  DrivePath path_;
  simulation::Town town_;
  simulation::Traffic traffic_;
  double max_range_m_ = 0;
};

DriveSimulator::Impl::Impl(const DriveConfig& given)
    : config_(checked(given)),
      sensor_(sensor_model(config_.sensor)),
      path_(config_.speed_mps, path_end_s(config_, sensor_)),
      town_(path_, {config_.seed, config_.parked_cars, config_.trees}),
      traffic_(config_.moving_cars, config_.seed),
      max_range_m_(config_.max_range_m > 0 ? config_.max_range_m : sensor_.max_range_m) {
  if (config_.sweeps == 0) config_.sweeps = sweeps_of_a_lap(config_, sensor_, path_);
}

void DriveSimulator::Impl::cast_column(std::size_t sweep, std::size_t column, const SE3& T_mid_world,
                                       Sweep& out) const {
  const double fraction = static_cast<double>(column) / static_cast<double>(sensor_.columns);
  const double t_s = (static_cast<double>(sweep) + fraction) * sensor_.period_s;
  const double azimuth = SensorModel::azimuth_rad(fraction);
  const SE3 T_world_sensor = pose_at(t_s);
  const SE3 T_mid_sensor = T_mid_world * T_world_sensor;
  const Eigen::Vector3d origin = T_world_sensor.translation();
  const auto traffic = traffic_.at(config_.start_s + t_s, path_, town_.terrain(), origin.head<2>(), max_range_m_);
  for (std::size_t ring = 0; ring < sensor_.beams(); ++ring) {
    // One return: the surface, then what the sensor makes of it.
    const double elevation = sensor_.elevations_rad[ring];
    const Eigen::Vector3d reported = direction(azimuth, elevation);
    const Eigen::Vector3d actual = direction(azimuth, elevation + config_.elevation_bias_deg * kRadPerDeg);
    simulation::RandomStream random(config_.seed, 0xbea3, sweep, column, ring);
    Hit hit;
    hit.range_m = max_range_m_;
    const Ray ray{origin, T_world_sensor.linear() * actual};
    town_.cast(ray, hit);
    traffic.cast(ray, hit);
    const bool lost = random.chance(config_.dropout);
    const bool through = hit.glass && !random.chance(kGlassAnswers);
    const double relative = hit.range_m / sensor_.max_range_m;
    const bool faint = hit.reflectivity * hit.cos_incidence < kFaintest * relative * relative;
    const double range = hit.range_m + config_.noise_m * random.normal();
    if (lost || through || faint || hit.range_m >= max_range_m_ || range < sensor_.min_range_m) continue;
    const double intensity = hit.reflectivity * std::sqrt(hit.cos_incidence) + kIntensityNoise * random.normal();
    const Eigen::Vector3d p = range * reported;
    out.points.push_back((config_.deskewed ? T_mid_sensor * p : p).cast<float>());
    if (!config_.deskewed) out.times_s.push_back(static_cast<float>(fraction * sensor_.period_s));
    out.intensities.push_back(static_cast<float>(std::clamp(intensity, 0.0, 1.0)));
    out.rings.push_back(static_cast<std::uint16_t>(ring));
  }
}

Sweep DriveSimulator::Impl::cast_columns(std::size_t sweep, std::size_t begin, std::size_t end,
                                         const SE3& T_mid_world) const {
  Sweep part;
  part.points.reserve((end - begin) * sensor_.beams());
  for (std::size_t column = begin; column < end; ++column) cast_column(sweep, column, T_mid_world, part);
  return part;
}

DriveSimulator::DriveSimulator(const DriveConfig& config) : impl_(std::make_unique<const Impl>(config)) {}
DriveSimulator::~DriveSimulator() = default;
DriveSimulator::DriveSimulator(DriveSimulator&&) noexcept = default;
DriveSimulator& DriveSimulator::operator=(DriveSimulator&&) noexcept = default;

std::size_t DriveSimulator::size() const { return impl_->config_.sweeps; }
const DriveConfig& DriveSimulator::config() const { return impl_->config_; }
const SensorModel& DriveSimulator::sensor() const { return impl_->sensor_; }
const DrivePath& DriveSimulator::path() const { return impl_->path_; }
SE3 DriveSimulator::pose_at(double t_s) const { return impl_->pose_at(t_s); }

SimulatedSweep DriveSimulator::sweep(std::size_t i) const {
  if (i >= size()) throw std::out_of_range("sweep " + std::to_string(i) + " of a drive of " + std::to_string(size()));
  const double period_s = sensor().period_s;
  const auto pose = [this, period_s](std::size_t sweep, double fraction) {
    return pose_at((static_cast<double>(sweep) + fraction) * period_s);
  };
  const auto since_first = [&pose, i](double fraction) {
    return i == 0 ? SE3(SE3::Identity()) : pose(0, fraction).inverse() * pose(i, fraction);
  };
  SimulatedSweep result;
  result.T_odom_lidar_start = since_first(0);
  result.T_odom_lidar_mid = since_first(0.5);
  result.T_odom_lidar_end = since_first(1);
  result.sweep.stamp_ns = std::llround(static_cast<double>(i) * period_s * kNanoseconds);

  // Columns in fixed chunks, joined in their order: the same sweep for any number of threads.
  constexpr std::size_t kChunk = 32;
  const SE3 T_mid_world = pose(i, 0.5).inverse();
  const std::size_t columns = sensor().columns;
  std::vector<Sweep> parts((columns + kChunk - 1) / kChunk);
  const auto cast_part = [&](std::size_t k) {
    parts[k] = impl_->cast_columns(i, k * kChunk, std::min(columns, (k + 1) * kChunk), T_mid_world);
  };
  tbb::task_arena arena(config().threads > 0 ? config().threads : tbb::task_arena::automatic);
  arena.execute([&] { for_each_index(parts.size(), cast_part); });
  for (Sweep& part : parts) append(result.sweep, std::move(part));
  return result;
}

}  // namespace rilo
