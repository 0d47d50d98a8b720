// rilo simulate: a synthetic drive as a KITTI-style folder.
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "checks.hpp"
#include "command.hpp"
#include "console/folder_lock.hpp"
#include "console/interrupt.hpp"
#include "console/progress.hpp"
#include "console/text.hpp"
#include "results/run_outputs.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/drive_writer.hpp"

namespace rilo::cli {

namespace {

struct SimulateFlags {
  DriveConfig drive;
  std::string out;
  bool quiet = false;
};

constexpr const char* kSimulateFooter = R"(Example:
  rilo simulate --out drive --sensor vlp16 --sweeps 100 --seed 7
The same options give the same bytes, whatever --threads is.)";

DriveSimulator make_drive(const DriveConfig& config) {
  try {
    return DriveSimulator(config);
  } catch (const std::invalid_argument& error) {
    // All ranges but this one, which depends on the sensor, are checked with the options.
    const std::string member = "DriveConfig::max_range_m";
    std::string message = error.what();
    if (message.starts_with(member)) message.replace(0, member.size(), "--max-range");
    throw RunError(RunErrorKind::kUsage, message);
  }
}

int simulate(const SimulateFlags& flags) {
  const DriveSimulator drive = make_drive(flags.drive);
  create_folder(flags.out);
  const FolderLock lock(flags.out);  // before anything of an earlier drive is removed
  Progress progress("simulating", drive.size(), flags.quiet);
  const InterruptGuard guard;
  DriveSummary summary;
  try {
    summary = write_drive(drive, flags.out, [&](std::size_t done, std::size_t) {
      progress.update(done);
      return InterruptGuard::signal() == 0;
    });
  } catch (const std::runtime_error& error) {
    throw RunError(RunErrorKind::kCannotWrite, error.what());
  }
  progress.finish();
  if (!flags.quiet) {
    std::cout << fmt::format("{}, {}, {:.1f} m: {}\n", counted(summary.sweeps, "sweep"),
                             counted(summary.points, "point"), summary.path_m, flags.out);
  }
  return InterruptGuard::signal() == 0 ? kSuccess : kSignalBase + InterruptGuard::signal();
}

void add_drive_flags(CLI::App& command, DriveConfig& drive) {
  add_choice(
      command, "--sensor", [&drive](const std::string& text) { drive.sensor = parse_sensor_kind(text).value(); },
      {"hdl64", "vlp16", "os1-64"}, "hdl64, vlp16 or os1-64. Default: hdl64");
  add_count(command, "--sweeps", drive.sweeps, 20000,
            "number of sweeps, 10 a second; 0: one lap and a little more; at most 20000");
  add_count(command, "--seed", drive.seed, kAnyCount, "town, traffic and noise");
  add_number(command, "--start", drive.start_s, 0, 2000, "s into the drive, 0 … 2000 (0: standing)");
  add_number(command, "--speed", drive.speed_mps, 2, 15, "m/s on straight streets, 2 … 15");
  add_number(command, "--noise", drive.noise_m, 0, 0.5, "m, 0 … 0.5: standard deviation of a range");
  add_number(command, "--dropout", drive.dropout, 0, 0.9, "share of returns that are lost, 0 … 0.9");
  add_number(command, "--max-range", drive.max_range_m, 0, 1000, "m; 0: the sensor's own");
  add_number(command, "--elevation-bias", drive.elevation_bias_deg, -2, 2,
             "degrees, -2 … 2: true minus reported elevation");
  add_count(command, "--moving-cars", drive.moving_cars, 12, "0 … 12");
  add_number(command, "--parked-cars", drive.parked_cars, 0, 1, "share of the parking places that are taken, 0 … 1");
  add_number(command, "--trees", drive.trees, 0, 1, "share of the places for trees that have one, 0 … 1");
  add_count(command, "--threads", drive.threads, 1024, "0: as many as the machine has");
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command = app.add_subcommand("simulate", "make a synthetic drive with exact ground truth");
  command->footer(kSimulateFooter);
  command->add_option("--out", flags->out, "folder of the drive (created)")->required()->check(path_given());
  add_drive_flags(*command, flags->drive);
  command->add_flag("--deskewed", flags->drive.deskewed, "points referred to the middle of the sweep, without times");
  command->add_flag("--quiet", flags->quiet, "no progress and no summary");
  command->callback([flags, &exit_code] { exit_code = simulate(*flags); });
}

}  // namespace rilo::cli
