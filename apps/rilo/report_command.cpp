// rilo report: one page that compares runs and experiments.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/report_inputs.hpp"
#include "bench/report_runs.hpp"
#include "bench/saved_results.hpp"
#include "checks.hpp"
#include "command.hpp"
#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "report/html_report.hpp"
#include "results/output_check.hpp"
#include "results/run_outputs.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kReportFooter =
    R"(Each of RESULTS is [[SEQUENCE/]NAME=]PATH, where PATH is
  a folder that rilo run wrote (--out; with its map when that is in the folder: --map FOLDER/map.ply),
  a folder, results.json or results.sqlite that rilo bench wrote, or
  a pose file of any program, KITTI, TUM or EuRoC form, poses of the LiDAR at the middle of the sweeps.
Runs over the same data are compared with each other; SEQUENCE/ is only needed with several sequences, for pose files
and killed runs. Truth is what lies beside the data that were run; --gt names another.

Examples:
  rilo run drive --out full --map full/map.ply
  rilo run drive --out plain --map plain/map.ply --set icp.adaptive=false
  rilo report full plain -o comparison.html
  rilo report Rilo=full KISS-ICP=kiss/poses.txt --gt drive/poses_mid.txt
  rilo report results/ablation results/sensitivity -o experiments.html
  rilo report 00/ours=a/00 01/ours=a/01 00/peer=b/00.txt 01/peer=b/01.txt --gt 00=truth/00.txt --gt 01=truth/01.txt)";

struct ReportFlags {
  std::vector<std::string> results;
  std::string out = "report.html";
  std::string title;
  std::vector<std::string> truths;
  PoseFlags poses;
};

void write_page(const std::string& file, const ReportPage& page) {
  const std::string html = html_report(page);
  guard_writing([&] { write_atomically(file, html); });
}

int report(const ReportFlags& flags) {
  ReportPage page;
  page.title = valid_utf8(flags.title);
  std::vector<ReportInput> inputs;
  for (const std::string& word : flags.results) {
    const ReportInput input = parse_report_input(word);
    if (input.kind != ReportInputKind::kBench) {
      inputs.push_back(input);
      continue;
    }
    page.experiments.push_back(read_saved_bench(input.path));
    if (!input.name.empty()) page.experiments.back().title = input.name;
  }
  std::vector<ReportTruth> truths;
  for (const std::string& word : flags.truths) truths.push_back(parse_report_truth(word));
  if (inputs.empty() && !truths.empty())
    throw RunError(RunErrorKind::kUsage, "--gt goes with runs and poses, not with rilo bench");
  check_replaced(flags.out, "Rilo</title>", "report", "-o");
  ReportRuns runs = report_runs(inputs, truths, flags.poses);
  page.runs = std::move(runs.runs);
  page.notices = std::move(runs.notices);
  write_page(flags.out, page);
  for (const std::string& notice : page.notices) std::cerr << "rilo: warning: " << notice << '\n';
  for (const RunReport& run : page.runs) {
    if (!run.notice.empty()) std::cerr << "rilo: warning: " << run.name << ": " << run.notice << '\n';
  }
  std::cout << fmt::format("{}: {}, {}\n", flags.out, counted(page.runs.size(), "run"),
                           counted(page.experiments.size(), "experiment"));
  return kSuccess;
}

void add_flags(CLI::App& command, ReportFlags& flags) {
  command.add_option("RESULTS", flags.results, "[[SEQUENCE/]NAME=]PATH of results or poses")
      ->required()
      ->check(path_given());
  command.add_option("-o,--out", flags.out, "the page to write")->check(path_given())->capture_default_str();
  command.add_option("--title", flags.title, "title of the page");
  command.add_option("--gt", flags.truths, "[SEQUENCE=]PATH of true poses, a file or a data folder; repeatable")
      ->allow_extra_args(false)
      ->check(path_given());
  add_choice(
      command, "--pose-frame", [&flags](const std::string& text) { flags.poses.camera_frame = text == "camera"; },
      {"lidar", "camera"}, "frame of given pose files: lidar, or camera (KITTI; needs Tr of the data). Default: lidar");
  add_number(command, "--max-gap-s", flags.poses.max_gap_s, 0, 1e6,
             "largest distance of two stamps that belong together");
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<ReportFlags>();
  CLI::App* command = app.add_subcommand("report", "one HTML page that compares runs and experiments");
  command->footer(kReportFooter);
  add_flags(*command, *flags);
  command->callback([flags, &exit_code] { exit_code = report(*flags); });
}

}  // namespace rilo::cli
