// rilo view: replay a finished run in the browser.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "checks.hpp"
#include "command.hpp"
#include "console/interrupt.hpp"
#include "console/text.hpp"
#include "results/live_view.hpp"
#include "results/saved_run.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"
#include "source_flags.hpp"
#include "view_flags.hpp"

namespace rilo::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReplaySweepBytes = 256U << 20U;
constexpr const char* kViewFooter =
    R"(RESULTS is a folder that rilo run --out has written. The sweeps are read again from where the run had them (the path in
metrics.json; --data when they have moved). Where they no longer exist, trajectory, figures and a map file in RESULTS
(.ply or .pcd) are shown. Options on how data are read must be those of the run; topic, elevation correction, parts and
times from azimuth (with the direction) or order are taken from metrics.json. Ctrl-C ends it.

Examples:
  rilo view results
  rilo view results --data moved/drive --port 8000)";

struct ViewFlags {
  std::string results;
  std::string data;
  bool no_truth = false;
  ViewOptions options;
  SourceRequest source;
};

/// Options of the run about the data, as far as its metrics have them.
SourceOptions source_options(const ViewFlags& flags, const RunMetrics& metrics) {
  SourceOptions options = flags.source.options;
  if (options.topic.empty()) options.topic = metrics.topic;
  if (options.elevation_correction_deg == 0.0) {
    options.elevation_correction_deg = metrics.elevation_correction_deg.value_or(0);
  }
  if (options.parts == 0) options.parts = static_cast<int>(metrics.parts);
  const std::string& times = metrics.point_times;
  if (options.point_times == PointTimes::kAuto && times.starts_with("azimuth")) {
    options.point_times = PointTimes::kAzimuth;
    if (times.find("counter-clockwise") != std::string::npos) options.spin_direction = SpinDirection::kCounterClockwise;
  }
  if (options.point_times == PointTimes::kAuto && times.starts_with("order")) options.point_times = PointTimes::kOrder;
  return options;
}

std::unique_ptr<ScanSource> open_data(const ViewFlags& flags, const std::string& data, const RunMetrics& metrics,
                                      std::string& note) {
  try {
    return open_scan_source(data, source_options(flags, metrics));
  } catch (const IoError& error) {
    if (!flags.data.empty()) throw;
    note = "The sweeps cannot be read again: trajectory, figures and map alone.";
    std::cerr << "rilo: warning: " << error.what() << " (--data: where the sweeps are now)\n";
    return nullptr;
  }
}

/// Other data under the same numbers would be shown as if the run had seen them.
void check_points(const Sweep& sweep, const RunRecord& run, std::size_t i, const std::string& data) {
  const std::size_t recorded = run.results[i].stats.points_in;
  if (sweep.points.size() == recorded) return;
  throw RunError(
      RunErrorKind::kBadData,
      fmt::format("{}: sweep {} has {}; expected {}, as in sweeps.csv. These are not the data of the run, or "
                  "are read with other options: give them with --data, and the run's options",
                  data, run.indices[i], counted(sweep.points.size(), "point"), recorded));
}

/// Sends all sweeps, with the points of those that `source` still gives. @throws RunError when they are other ones.
void send_sweeps(LiveView& view, const RunRecord& run, ScanSource* source, const std::string& data) {
  const bool known = std::any_of(run.results.begin(), run.results.end(),
                                 [](const SweepResult& result) { return result.stats.points_in > 0; });
  std::size_t done = 0;
  try {
    if (source != nullptr && !run.indices.empty()) source->skip(run.indices.front());
    while (source != nullptr && done < run.results.size() && InterruptGuard::signal() == 0) {
      std::optional<Sweep> sweep = source->next();
      if (!sweep) break;
      const std::size_t index = source->current_index();
      for (; done < run.results.size() && run.indices[done] < index; ++done) {
        view.show(run.indices[done], run.results[done], {});
      }
      if (done < run.results.size() && run.indices[done] == index) {
        if (known) check_points(*sweep, run, done, data);
        view.show(index, run.results[done], std::move(*sweep));
        ++done;
      }
    }
  } catch (const IoError& error) {
    std::cerr << "rilo: warning: " << error.what() << '\n';
  }
  for (; done < run.results.size(); ++done) view.show(run.indices[done], run.results[done], {});
}

void send_map(LiveView& view, const RunRecord& run) {
  if (!run.map.points.empty()) view.viewer().add_map(run.map.points, first_seen(run.map.points, run.results));
}

int replay(ViewFlags flags) {
  const fs::path folder = flags.results;
  const SavedRun saved = read_saved_run(folder);
  if (saved.killed) {
    throw IoError({folder / "metrics.json", "", "no such file: the run was killed or is still running",
                   "a finished run", "Run rilo run again"});
  }
  const RunRecord& run = saved.record;
  const std::string data = flags.data.empty() ? run.data.string() : flags.data;
  ViewInfo info = view_info(data, run.config);
  info.live = false;
  info.sweeps = run.results.size();
  const auto source = open_data(flags, data, saved.metrics, info.note);
  info.points = source != nullptr;
  flags.options.share = 1.0;
  flags.options.sweep_bytes = kReplaySweepBytes;

  const InterruptGuard guard;
  LiveView live(info, flags.options, flags.no_truth ? std::nullopt : std::optional(TruthTrack(data)));
  send_sweeps(live, run, source.get(), data);
  if (!source) send_map(live, run);
  live.viewer().finish();
  InterruptGuard::wait();
  return kSuccess;
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<ViewFlags>();
  CLI::App* command = app.add_subcommand("view", "replay a finished run in the browser");
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
