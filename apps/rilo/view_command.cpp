// rilo view: a finished run once more, in the browser.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "checks.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "live_view.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"
#include "source_flags.hpp"
#include "text.hpp"
#include "view_flags.hpp"
#include "view_recording.hpp"

namespace rilo::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReplaySweepBytes = 256U << 20U;
constexpr const char* kViewFooter =
    R"(RESULTS is a folder that rilo run --out has written. The sweeps are read again from where the run had them (the path in
metrics.json; --data when they have moved). Where they are no more, trajectory, figures and a map file in RESULTS (.ply
or .pcd) are shown. Options that say how data are read must be those of the run; topic, elevation correction and
azimuth times are taken from metrics.json. Ctrl-C ends it.

Examples:
  rilo view results
  rilo view results --data moved/drive --port 8000)";

struct ViewFlags {
  std::string results;
  std::string data;
  bool no_truth = false;
  ViewOptions options;
  SourceFlags source;
};

/// What the run was told about the data, as far as its figures say so.
SourceOptions source_options(const ViewFlags& flags, const nlohmann::json& metrics) {
  SourceOptions options = flags.source.options;
  if (options.topic.empty()) options.topic = metrics.value("topic", std::string());
  if (options.elevation_correction_deg == 0.0) {
    options.elevation_correction_deg = metrics.value("elevation_correction_deg", 0.0);
  }
  const std::string times = metrics.value("point_times", std::string());
  if (options.point_times == PointTimes::kAuto && times.starts_with("azimuth")) {
    options.point_times = PointTimes::kAzimuth;
    if (times.find("counter-clockwise") != std::string::npos) {
      options.spin_direction = SpinDirection::kCounterClockwise;
    }
  }
  return options;
}

std::unique_ptr<ScanSource> open_data(const ViewFlags& flags, const std::string& data, const nlohmann::json& metrics,
                                      std::string& note) {
  try {
    return open_scan_source(data, source_options(flags, metrics));
  } catch (const IoError& error) {
    if (!flags.data.empty()) throw;
    note = "The sweeps cannot be read again: trajectory, figures and map alone.";
    std::cerr << "rilo: warning: " << error.what() << " (--data says where the sweeps are now)\n";
    return nullptr;
  }
}

/// Sends all sweeps, with the points of those that `source` still gives.
void send_sweeps(LiveView& view, const RecordedRun& run, ScanSource* source) {
  std::size_t done = 0;
  try {
    while (source != nullptr && done < run.results.size() && InterruptGuard::signal() == 0) {
      std::optional<Sweep> sweep = source->next();
      if (!sweep) break;
      const std::size_t index = source->current_index();
      for (; done < run.results.size() && run.indices[done] < index; ++done) {
        view.show(run.indices[done], run.results[done], {});
      }
      if (done < run.results.size() && run.indices[done] == index) {
        view.show(index, run.results[done], std::move(*sweep));
        ++done;
      }
    }
  } catch (const IoError& error) {
    std::cerr << "rilo: warning: " << error.what() << '\n';
  }
  for (; done < run.results.size(); ++done) view.show(run.indices[done], run.results[done], {});
}

void send_map(LiveView& view, const RecordedRun& run, const fs::path& folder) {
  const auto file = recorded_map(folder);
  if (!file) return;
  const auto points = (file->extension() == ".ply" ? read_ply(*file) : read_pcd(*file)).points;
  view.viewer().add_map(points, first_seen(points, run.results));
}

int replay(ViewFlags flags) {
  const fs::path folder = flags.results;
  const RecordedRun run = read_recorded_run(folder);
  const std::string data = flags.data.empty() ? run.metrics.value("data", std::string()) : flags.data;
  const fs::path config = folder / "config.yaml";
  ViewInfo info = view_info(data, fs::exists(config) ? load_config(config) : OdometryConfig{});
  info.live = false;
  info.sweeps = run.results.size();
  const auto source = open_data(flags, data, run.metrics, info.note);
  info.points = source != nullptr;
  flags.options.share = 1.0;
  flags.options.sweep_bytes = kReplaySweepBytes;

  const InterruptGuard guard;
  LiveView live(info, flags.options, flags.no_truth ? std::nullopt : std::optional(TruthTrack(data)));
  send_sweeps(live, run, source.get());
  if (!source) send_map(live, run, folder);
  live.viewer().finish();
  wait_for_signal();
  return kSuccess;
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<ViewFlags>();
  CLI::App* command = app.add_subcommand("view", "a finished run once more, in the browser");
  command->footer(kViewFooter);
  command->add_option("RESULTS", flags->results, "folder of results")->required()->check(path_given());
  command->add_option("--data", flags->data, "where the sweeps are now")->check(path_given());
  command
      ->add_option_function<std::uint16_t>(
          "--port", [flags](std::uint16_t port) { flags->options.port = port; },
          "port; 0: any free one. Default: 7456, or a free one where that is taken")
      ->check(whole_number(65535));
  add_address_flag(*command, "--address", flags->options);
  command->add_flag("--no-truth", flags->no_truth, "do not look for ground truth");
  add_source_flags(*command, flags->source);
  command->callback([flags, &exit_code] { exit_code = replay(*flags); });
}

}  // namespace rilo::cli
