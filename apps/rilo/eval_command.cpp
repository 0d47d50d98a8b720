// rilo eval: estimated trajectories against ground truth.
#include <algorithm>
#include <iostream>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "checks.hpp"
#include "command.hpp"
#include "console/text.hpp"
#include "report/figures.hpp"
#include "results/evaluation_output.hpp"
#include "results/metrics_json.hpp"
#include "results/pose_files.hpp"
#include "results/run_metrics.hpp"

namespace rilo::cli {

namespace {

struct EvalFlags {
  std::string truth;
  std::string estimate;
  std::vector<std::string> more;
  PoseInstant instant = PoseInstant::kMid;
  PairingOptions pairing;
  bool json = false;
};

constexpr const char* kEvalFooter =
    R"(GT is a pose file or a data folder with ground truth; EST is a pose file. KITTI form (12 numbers a line), TUM form
(t x y z qx qy qz qw) or EuRoC form (ns,x,y,z,qw,qx,qy,qz) is detected from the first line. Both must be poses of the
same sensor at the same time within the sweep: rilo's are at the middle (pose_instant in metrics.json); for a drive
simulator's folder --instant chooses the truth. KITTI's own ground truth is in the camera frame: compare it with
poses_camera.txt.

Examples:
  rilo eval drive results/poses_lidar.txt
  rilo eval gt.tum results/trajectory.tum --max-gap-s 0.05
  rilo eval poses/00.txt out/00/poses_camera.txt poses/01.txt out/01/poses_camera.txt     both averages over sequences)";

struct Sequence {
  std::string truth;
  std::string estimate;
  std::string protocol;
  std::vector<std::string> warnings;
  Evaluation evaluation;
  bool by_stamp = false;
  bool of_instant = false;
};

Sequence evaluate_pair(const EvalFlags& flags, const std::string& truth_path, const std::string& estimate_path) {
  const PoseFile truth = read_truth(truth_path, flags.instant);
  const PoseFile estimate = read_poses(estimate_path);
  const PairedPoses paired = pair_poses(truth, estimate, flags.pairing);
  for (const std::string& warning : paired.warnings) {
    std::cerr << "rilo: warning: " << estimate_path << ": " << warning << '\n';
  }
  return {valid_utf8(truth.file.string()),
          valid_utf8(estimate_path),
          paired.protocol,
          paired.warnings,
          evaluate(paired.poses.truth, paired.poses.estimate),
          paired.by_stamp,
          truth.of_instant};
}

nlohmann::json sequence_json(const Sequence& sequence) {
  nlohmann::json json = to_json(evaluation_metrics(sequence.evaluation));
  json["truth"] = sequence.truth;
  json["estimate"] = sequence.estimate;
  json["protocol"] = sequence.protocol;
  json["warnings"] = sequence.warnings;
  return json;
}

/// The averages are over the sequences of which a t_rel is shown.
std::vector<KittiError> averaged(const std::vector<Sequence>& sequences) {
  std::vector<KittiError> errors;
  for (const Sequence& sequence : sequences) {
    if (shows_t_rel(sequence.evaluation)) errors.push_back(sequence.evaluation.kitti);
  }
  return errors;
}

void print_json(const std::vector<Sequence>& sequences) {
  nlohmann::json json;
  if (sequences.size() == 1) {
    json = sequence_json(sequences.front());
  } else {
    for (const Sequence& sequence : sequences) json["sequences"].push_back(sequence_json(sequence));
  }
  json.update(benchmark_json(kitti_benchmark(averaged(sequences))));
  std::cout << json_text(json);
}

void print_table(const std::vector<Sequence>& sequences) {
  for (const Sequence& sequence : sequences) {
    std::cout << fmt::format("{} against {}\n{}\n{}\n", sequence.estimate, sequence.truth, sequence.protocol,
                             evaluation_table(sequence.evaluation));
  }
  const std::vector<KittiError> errors = averaged(sequences);
  std::cout << benchmark_table(kitti_benchmark(errors), errors.size());
}

/// Options that make no difference to any of the sequences.
void warn_of_idle_options(const CLI::App& command, const std::vector<Sequence>& sequences) {
  const auto any = [&](const auto& uses) { return std::any_of(sequences.begin(), sequences.end(), uses); };
  const auto check = [&](const char* option, bool used, const char* why) {
    if (command.count(option) == 0 || used) return;
    std::cerr << "rilo: warning: " << option << " is ignored: " << why << '\n';
  };
  check("--start", any([](const Sequence& s) { return !s.by_stamp; }), "the poses are paired by stamp");
  check("--max-gap-s", any([](const Sequence& s) { return s.by_stamp; }), "the poses are paired by index");
  check("--instant", any([](const Sequence& s) { return s.of_instant; }), "GT is not a drive simulator's folder");
}

int eval(const EvalFlags& flags, const CLI::App& command) {
  if (flags.more.size() % 2 != 0) throw RunError(RunErrorKind::kUsage, "eval: further files come in pairs GT EST");
  std::vector<Sequence> sequences = {evaluate_pair(flags, flags.truth, flags.estimate)};
  for (std::size_t i = 0; i + 1 < flags.more.size(); i += 2) {
    sequences.push_back(evaluate_pair(flags, flags.more[i], flags.more[i + 1]));
  }
  warn_of_idle_options(command, sequences);
  if (flags.json) {
    print_json(sequences);
  } else {
    print_table(sequences);
  }
  return kSuccess;
}

void add_flags(CLI::App& command, EvalFlags& flags) {
  command.add_option("GT", flags.truth, "true poses: a file, or a data folder")->required()->check(path_given());
  command.add_option("EST", flags.estimate, "estimated poses")->required()->check(path_given());
  command.add_option("MORE", flags.more, "further pairs GT EST, one per sequence")->check(path_given());
  add_choice(
      command, "--instant", [&flags](const std::string& text) { flags.instant = parse_pose_instant(text).value(); },
      {"start", "mid", "end"},
      "time within the sweep of the true poses when GT is a drive simulator's folder. Default: mid");
  add_choice(
      command, "--associate", [&flags](const std::string& text) { flags.pairing.pairing = parse_pairing(text); },
      {"auto", "index", "stamp"},
      "pair poses by index or by stamp. Default: auto, by stamp when both have stamps, a data folder too");
  add_number(command, "--max-gap-s", flags.pairing.max_gap_s, 0, 1e6,
             "largest distance of two stamps that belong together");
  add_count(command, "--start", flags.pairing.first, kAnyCount,
            "by index: the true pose that EST begins with, as for run --start");
  command.add_flag("--json", flags.json, "print JSON");
}

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<EvalFlags>();
  flags->pairing.index_advised = true;
  CLI::App* command = app.add_subcommand("eval", "errors of trajectories against ground truth");
  command->footer(kEvalFooter);
  add_flags(*command, *flags);
  command->callback([flags, command, &exit_code] { exit_code = eval(*flags, *command); });
}

}  // namespace rilo::cli
