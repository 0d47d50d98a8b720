// rilo simulate: a synthetic drive as a KITTI-style folder.
#include <iostream>

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "rilo/simulation/drive_writer.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

struct SimulateFlags {
  DriveConfig drive;
  std::string out;
  bool quiet = false;
};

constexpr const char* kFooter = R"(Example:
  rilo simulate --out drive --sensor vlp16 --sweeps 100 --seed 7
The same options give the same bytes, whatever --threads is.)";

int simulate(const SimulateFlags& flags) {
  const DriveSimulator drive(flags.drive);
  Progress progress("simulating", drive.size(), flags.quiet);
  const InterruptGuard guard;
  DriveSummary summary;
  try {
    summary = write_drive(drive, flags.out, [&](std::size_t done, std::size_t) {
      progress.update(done);
      return InterruptGuard::signal() == 0;
    });
  } catch (const std::runtime_error& error) {
    throw CommandError(kCannotWrite, error.what());
  }
  progress.finish();
  if (!flags.quiet) {
    std::cout << fmt::format("{}, {} points, {:.1f} m: {}\n", counted(summary.sweeps, "sweep"), summary.points,
                             summary.path_m, flags.out);
  }
  return InterruptGuard::signal() == 0 ? kSuccess : kSignalBase + InterruptGuard::signal();
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command = app.add_subcommand("simulate", "make a synthetic drive with exact ground truth");
  command->footer(kFooter);
  DriveConfig& drive = flags->drive;
  command->add_option("--out", flags->out, "folder of the drive (created)")->required();
  command
      ->add_option_function<std::string>(
          "--sensor", [&drive](const std::string& text) { drive.sensor = parse_sensor_kind(text).value(); },
          "hdl64, vlp16 or os1-64")
      ->check(CLI::IsMember({"hdl64", "vlp16", "os1-64"}));
  command->add_option("--sweeps", drive.sweeps, "number of sweeps, 10 a second; 0: a lap and a bit")
      ->capture_default_str();
  command->add_option("--seed", drive.seed, "town, traffic and noise")->capture_default_str();
  command->add_option("--start", drive.start_s, "seconds into the drive (0: standing)")->capture_default_str();
  command->add_option("--speed", drive.speed_mps, "m/s on straight streets")->capture_default_str();
  command->add_option("--noise", drive.noise_m, "standard deviation of a range, m")->capture_default_str();
  command->add_option("--dropout", drive.dropout, "share of returns that are lost")->capture_default_str();
  command->add_option("--elevation-bias", drive.elevation_bias_deg, "degrees, true less reported elevation")
      ->capture_default_str();
  command->add_option("--max-range", drive.max_range_m, "m; 0: the sensor's own")->capture_default_str();
  command->add_option("--moving-cars", drive.moving_cars, "0 … 12")->capture_default_str();
  command->add_option("--parked-cars", drive.parked_cars, "share of the parking places that are taken")
      ->capture_default_str();
  command->add_option("--trees", drive.trees, "share of the places for trees that have one")->capture_default_str();
  command->add_option("--threads", drive.threads, "0: as many as the machine has")->capture_default_str();
  command->add_flag("--deskewed", drive.deskewed, "points referred to the middle of the sweep, without times");
  command->add_flag("--quiet", flags->quiet, "no progress and no summary");
  command->callback([flags, &exit_code] { exit_code = simulate(*flags); });
}

}  // namespace rilo::cli
