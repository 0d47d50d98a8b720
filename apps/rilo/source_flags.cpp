#include "source_flags.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "checks.hpp"

namespace rilo::cli {

namespace {

void add_time_flags(CLI::App& command, SourceRequest& flags) {
  SourceOptions& options = flags.options;
  add_choice(
      command, "--point-times",
      [&flags](const std::string& text) {
        flags.times_needed = text == "data";
        flags.options.point_times = flags.times_needed ? PointTimes::kAuto : parse_point_times(text).value();
      },
      {"auto", "data", "azimuth", "order", "none"},
      "per-point times for motion compensation. auto: from the data when it has them; data: the same, and an error "
      "when it has none; azimuth: from the angle of a spinning sensor (--spin) whose sweep is stamped at the forward "
      "direction (KITTI raw); order: from the order of the points of a spinning sensor; none: the points are "
      "compensated already. Default: auto");
  add_choice(
      command, "--point-time-unit",
      [&options](const std::string& text) { options.point_time_unit = parse_point_time_unit(text).value(); },
      {"infer", "s", "ms", "us", "ns", "fraction"}, "unit of the time field when it cannot be inferred from the data");
  add_choice(
      command, "--point-time-reference",
      [&options](const std::string& text) { options.point_time_reference = parse_point_time_reference(text).value(); },
      {"infer", "stamp", "epoch"}, "what the time field counts from: the sweep's stamp or an epoch");
  command.add_option("--time-field", options.time_field,
                     "name of the field with the point times, of a PCD, a PLY or a PointCloud2");
  add_choice(
      command, "--spin",
      [&options](const std::string& text) { options.spin_direction = parse_spin_direction(text).value(); },
      {"clockwise", "counter-clockwise"}, "rotation direction seen from above, for --point-times azimuth");
}

}  // namespace

void add_source_flags(CLI::App& command, SourceRequest& flags) {
  SourceOptions& options = flags.options;
  command.add_option("--topic", options.topic, "topic of a recording that has several with scans");
  command.add_option("--sensor-file", options.sensor_file,
                     "what packets need: an Ouster's metadata (JSON; by default the one in or beside the recording) or "
                     "an HDL-64E's calibration (YAML of velodyne_pointcloud)");
  command
      .add_option("--bin-fields", options.bin_fields,
                  "columns of a .bin record, float32 each: x,y,z and intensity, time, ring; _ is ignored")
      ->capture_default_str();
  add_time_flags(command, flags);
  add_number(command, "--elevation-correction", options.elevation_correction_deg, -10, 10,
             "degrees added to every point's elevation angle. KITTI's HDL-64E needs 0.205. Off by default; stated in "
             "every result");
  command.add_option("--rate", options.rate_hz, "sweeps per second of data without stamps")
      ->check(number_within(0.001, 1000))
      ->default_str(fmt::format("{:g}", options.assumed_rate_hz()));
  command
      .add_option("--parts", options.parts,
                  "messages or files that hold a sweep in parts and are joined to one; 1: none are. Default: 0, found "
                  "out where they come faster than 13 a second")
      ->check(whole_number(SourceOptions::kMostParts));
  command.add_flag_callback(
      "--skip-bad-sweeps", [&options] { options.on_bad_sweep = OnBadSweep::kSkip; },
      "skip sweeps that cannot be read (counted in the results) instead of stopping");
}

}  // namespace rilo::cli
