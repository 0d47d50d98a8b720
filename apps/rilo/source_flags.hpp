// Command-line options that say how data are read; shared by run and info.
#pragma once

#include <CLI/CLI.hpp>

#include "rilo/io/source_options.hpp"

namespace rilo::cli {

/// Adds --bin-fields, --point-times and the others to `command`; they end up in `options`.
inline void add_source_flags(CLI::App& command, SourceOptions& options) {
  command
      .add_option("--bin-fields", options.bin_fields,
                  "columns of a .bin record, float32 each: x,y,z and intensity, time, ring; _ is ignored")
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--point-times",
          [&options](const std::string& text) { options.point_times = parse_point_times(text).value(); },
          "per-point times: auto (from the data when it has them), none, azimuth (spinning sensor, sweep stamped "
          "facing forward; KITTI raw)")
      ->check(CLI::IsMember({"auto", "none", "azimuth"}));
  command
      .add_option_function<std::string>(
          "--point-time-unit",
          [&options](const std::string& text) { options.point_time_unit = parse_point_time_unit(text).value(); },
          "unit of the time field when it cannot be told from the data")
      ->check(CLI::IsMember({"infer", "s", "ms", "us", "ns", "fraction"}));
  command
      .add_option_function<std::string>(
          "--point-time-reference",
          [&options](const std::string& text) {
            options.point_time_reference = parse_point_time_reference(text).value();
          },
          "what the time field counts from: the sweep's stamp or an epoch")
      ->check(CLI::IsMember({"infer", "stamp", "epoch"}));
  command.add_option("--time-field", options.time_field, "name of the PCD or PLY field with the point times");
  command
      .add_option_function<std::string>(
          "--spin",
          [&options](const std::string& text) { options.spin_direction = parse_spin_direction(text).value(); },
          "sense of rotation seen from above, for --point-times azimuth")
      ->check(CLI::IsMember({"clockwise", "counter-clockwise"}));
  command
      .add_option("--elevation-correction", options.elevation_correction_deg,
                  "degrees added to every point's elevation angle; KITTI's HDL-64E needs 0.205. Off by default, stated "
                  "in every result")
      ->capture_default_str();
  command.add_option("--rate", options.assumed_rate_hz, "sweeps per second of data without stamps")
      ->capture_default_str();
  command.add_flag_callback(
      "--skip-bad-sweeps", [&options] { options.on_bad_sweep = OnBadSweep::kSkip; },
      "leave out sweeps that cannot be read (counted in the results) instead of stopping");
}

}  // namespace rilo::cli
