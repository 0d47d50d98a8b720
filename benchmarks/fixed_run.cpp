// A short run that is the same on every machine, for counting instructions (scripts/instructions.sh).
#include <cstddef>
#include <iostream>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace {

constexpr std::size_t kWarmUp = 10;
constexpr std::size_t kMeasured = 20;
constexpr double kDrivingS = 20;  // the vehicle is at full speed by then

}  // namespace

/// What callgrind collects: a sweep in steady state. Its name has no mangling, so that a script can ask for it.
extern "C" __attribute__((noinline)) void rilo_measured_sweep(rilo::Odometry& odometry, const rilo::Sweep& sweep,
                                                              rilo::SweepResult& result) {
  result = odometry.register_sweep(sweep);
}

int main() {
  rilo::DriveConfig drive;
  drive.sensor = rilo::SensorKind::kVlp16;  // simulating under callgrind is slow
  drive.sweeps = kWarmUp + kMeasured;
  drive.start_s = kDrivingS;
  drive.threads = 1;
  const rilo::DriveSimulator simulator(drive);

  rilo::OdometryConfig config;
  config.threads = 1;
  rilo::Odometry odometry(config);
  rilo::SweepResult result;
  std::size_t ok = 0;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const rilo::Sweep sweep = simulator.sweep(i).sweep;
    if (i < kWarmUp) {
      odometry.register_sweep(sweep);
      continue;
    }
    rilo_measured_sweep(odometry, sweep, result);
    ok += result.status == rilo::OdometryStatus::kOk ? 1 : 0;
  }
  std::cout << kMeasured << " sweeps, " << ok << " ok\n";
  return ok == kMeasured ? 0 : 1;
}
