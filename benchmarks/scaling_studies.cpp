#include "scaling_studies.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/steady_clock.hpp"
#include "measured_row.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/drive_path.hpp"

namespace rilo::bench {
namespace {

constexpr double kDrivingS = 20;         // the vehicle is at full speed by then
constexpr double kPeriodS = 0.1;         // of a sweep
constexpr std::size_t kMemoryRows = 40;  // at most that many lines of the memory study

using Change = std::function<Sweep(const Sweep&)>;

/// One setting of a study.
struct Variant {
  double value = 0;
  OdometryConfig config;
  Change change;  ///< of the simulated sweep; empty: none
};

OdometryConfig single_thread() {
  OdometryConfig config;
  config.threads = 1;
  return config;
}

DriveConfig full_speed(const StudySize& size) {
  DriveConfig drive;
  drive.sweeps = size.warm_up + size.measured;
  drive.start_s = kDrivingS;
  return drive;
}

/// Every variant gets every sweep of the drive, one after the other, so that a busy machine slows them all alike.
void measure(const std::string& study, const DriveConfig& drive, std::size_t warm_up,
             const std::vector<Variant>& variants, std::ostream& out) {
  const DriveSimulator simulator(drive);
  std::vector<Odometry> odometries;
  for (const Variant& variant : variants) {
    odometries.emplace_back(variant.config, steady_ns);
  }
  std::vector<MeasuredRow> rows(variants.size());
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const Sweep sweep = simulator.sweep(i).sweep;
    for (std::size_t k = 0; k < variants.size(); ++k) {
      const Change& change = variants[k].change;
      const SweepResult result = odometries[k].register_sweep(change ? change(sweep) : sweep);
      if (i >= warm_up) {
        rows[k].add(result);
      }
    }
  }
  for (std::size_t k = 0; k < variants.size(); ++k) {
    rows[k].write(out, study, variants[k].value);
  }
}

/// Exactly `count` points: evenly picked ones of the sweep or, beyond its size, all of them and copies that lie a
/// little beside them, as a sensor with more beams would give. An empty sweep stays empty.
Sweep with_points(const Sweep& sweep, std::size_t count) {
  constexpr float kBesideM = 0.02F;
  const std::size_t size = sweep.points.size();
  Sweep out;
  out.stamp_ns = sweep.stamp_ns;
  if (size == 0) {
    return out;
  }
  std::mt19937 engine(1);
  std::normal_distribution<float> beside(0.0F, kBesideM);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = count <= size ? i * size / count : i % size;
    const bool copy = i >= size;
    const Eigen::Vector3f shift(copy ? beside(engine) : 0, copy ? beside(engine) : 0, copy ? beside(engine) : 0);
    out.points.push_back(sweep.points[from] + shift);
    out.times_s.push_back(sweep.times_s[from]);
  }
  return out;
}

/// Number of sweeps from standing at the start of the course to the next stop.
std::size_t sweeps_to_stop(const DriveConfig& config) {
  constexpr double kMovingMps = 2.0;
  constexpr double kStandingMps = 0.05;
  constexpr std::size_t kMost = 2000;
  DriveConfig longest = config;
  longest.sweeps = kMost;
  const DriveSimulator simulator(longest);
  const auto speed = [&](std::size_t i) { return simulator.path().speed_mps(static_cast<double>(i) * kPeriodS); };
  std::size_t i = 0;
  while (i + 1 < kMost && speed(i) < kMovingMps) {
    ++i;
  }
  while (i + 1 < kMost && speed(i) > kStandingMps) {
    ++i;
  }
  return i + 1;
}

/// The sweeps of a drive to and fro; points only, which is what the odometry reads of them.
std::vector<std::vector<Eigen::Vector3f>> closed_drive() {
  DriveConfig drive;
  drive.sensor = SensorKind::kVlp16;  // all sweeps stay in memory
  drive.deskewed = true;              // a sweep whose times run forward would contradict a drive backward
  drive.moving_cars = 0;
  drive.sweeps = sweeps_to_stop(drive);
  const DriveSimulator simulator(drive);
  std::vector<std::vector<Eigen::Vector3f>> sweeps;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    sweeps.push_back(simulator.sweep(i).sweep.points);
    sweeps.back().shrink_to_fit();
  }
  return sweeps;
}

}  // namespace

void study_points(const StudySize& size, std::ostream& out) {
  std::vector<Variant> variants;
  for (std::size_t points = 16'384; points <= 262'144; points *= 2) {
    variants.push_back({static_cast<double>(points), single_thread(),
                        [points](const Sweep& sweep) { return with_points(sweep, points); }});
  }
  measure("points", full_speed(size), size.warm_up, variants, out);
}

void study_map(const StudySize& size, std::ostream& out) {
  constexpr double kLeastM = 15;
  constexpr double kMostM = 240;
  std::vector<Variant> variants;
  for (double radius_m = kLeastM; radius_m <= kMostM; radius_m *= 2) {
    variants.push_back({radius_m, single_thread(), {}});
    variants.back().config.map.radius_m = radius_m;
  }
  // The vehicle has to drive as far as the largest map reaches before that one is full.
  StudySize longer = size;
  const double metres_per_sweep = DriveConfig().speed_mps * kPeriodS;
  longer.warm_up = std::max(size.warm_up, static_cast<std::size_t>(kMostM / metres_per_sweep));
  measure("map", full_speed(longer), longer.warm_up, variants, out);
}

void study_threads(const StudySize& size, std::ostream& out) {
  std::vector<Variant> variants;
  for (const int threads : {1, 2}) {
    variants.push_back({static_cast<double>(threads), single_thread(), {}});
    variants.back().config.threads = threads;
  }
  measure("threads", full_speed(size), size.warm_up, variants, out);
}

void study_speed(const StudySize& size, std::ostream& out) {
  for (const double speed_mps : {2.0, 5.0, 10.0, 15.0}) {
    DriveConfig drive = full_speed(size);
    drive.speed_mps = speed_mps;
    measure("speed", drive, size.warm_up, {{speed_mps, single_thread(), {}}}, out);
  }
}

void study_memory(const StudySize& size, std::ostream& out) {
  const std::vector<std::vector<Eigen::Vector3f>> sweeps = closed_drive();
  const std::size_t turn = sweeps.size() - 1;
  const std::size_t each = std::max<std::size_t>(size.measured / kMemoryRows, 1);
  Odometry odometry(single_thread(), steady_ns);
  MeasuredRow row;
  Sweep sweep;
  for (std::size_t i = 0; i < size.measured; ++i) {
    const std::size_t phase = i % (2 * turn);
    sweep.stamp_ns = std::llround(static_cast<double>(i) * kPeriodS * 1e9);
    sweep.points = sweeps[phase <= turn ? phase : 2 * turn - phase];
    row.add(odometry.register_sweep(sweep));
    if (row.sweeps() == each || i + 1 == size.measured) {
      row.write(out, "memory", static_cast<double>(i + 1));
      row.clear();
    }
  }
}

}  // namespace rilo::bench
