// rilo bench: several configurations on several sequences.
#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "bench/runner.hpp"
#include "bench_jobs.hpp"
#include "checks.hpp"
#include "command.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kBenchFooter =
    R"(FILE lists sequences and configurations; each configuration is run on each sequence, in a process of its own. See
docs/bench.md for its keys. A cell that fails is reported, the others still run; the exit code at the end is that of the
first failure. Ctrl-C ends the benchmark and writes what is finished. The same command again runs only what is not
finished: cells that failed, that were interrupted, or whose data, configuration or program were changed.

  configurations:
    - name: full
    - name: A, no coarse registration
      set: [coarse.enabled=false]

Leaves in --out: results.json, results.csv, results.md, results.sqlite, with peers paired.csv; in cells/ a file and a log
per cell.

Examples:
  rilo bench experiments/ablation.yaml --root drives --out results --jobs 4
  rilo bench experiments/ablation.yaml --data drives/a drives/b
  rilo bench my.yaml --count 200 --baseline results/results.json
  rilo bench my.yaml --out results --on slurm --sbatch=--time=60 --retries 2
  rilo bench experiments/panel.yaml --root drives --peer-figures peers.csv --out results
  rilo bench show results
  rilo bench kitti data/kitti --out results/kitti
  rilo bench m2dgr data/m2dgr)";

constexpr const char* kShowFooter =
    R"(Examples:
  rilo bench show results
  rilo bench show results/results.sqlite --format csv --no-times)";

constexpr const char* kKittiFooter =
    R"(ROOT/sequences/00/velodyne …, ROOT/sequences/00/calib.txt and ROOT/poses/00.txt as in the KITTI odometry data set;
those of 00 … 10 that exist are run, each three times: with elevation corrections of 0 and of 0.205 degrees, both with
elevation.enabled=false as the paper has nothing like it, and as Rilo runs by default, with its own estimate.

Example:
  rilo bench kitti data/kitti --out results/kitti)";

constexpr const char* kM2dgrFooter =
    R"(Each sequence is a bag ROOT/NAME.bag, or a folder ROOT/NAME/ of sweeps that rilo run can open (.pcd, .ply or .bin,
with stamps in times.txt or in the files' names), which goes before the bag. Its true poses are in ROOT/NAME.txt (TUM
form, as M2DGR provides them). hall_01, hall_02, hall_03, room_01, door_01 and lift_01 are those of the paper's table.

Example:
  rilo bench m2dgr data/m2dgr --out results/m2dgr)";

/// `plan`: the command has a FILE.
void add_common_flags(CLI::App& command, BenchFlags& flags, bool plan) {
  BenchOrder& order = flags.order;
  command.add_option("--out", order.out, "folder for the results (created); what is finished there is not run again")
      ->check(path_given());
  command
      .add_option("--baseline", order.baseline,
                  "folder, results.json or results.sqlite of an earlier benchmark to print the difference to")
      ->check(path_given());
  command
      .add_option(
          "--count", order.run.count,
          std::string("run that many sweeps of every sequence; 0: ") + (plan ? "as FILE says, else all" : "all"))
      ->check(whole_number());
  command
      .add_option("--threads", order.run.threads,
                  "threads; 0: as many as the machine has. Default: as configured; with --jobs, an equal share of the "
                  "machine's; on Slurm, the processors of the task")
      ->check(whole_number(1024));
  add_choice(
      command, "--on", [&order](const std::string& where) { order.on_slurm = where == "slurm"; }, {"local", "slurm"},
      "local (default), or slurm: cells as job arrays, see docs/cluster.md");
  command
      .add_option("--jobs", order.at_a_time,
                  "cells at a time; default: one here (times are then its own), on Slurm as many as it has room for")
      ->check(whole_number(10000));
  command.add_option("--retries", order.retries, "run a cell that failed that many times more")
      ->check(whole_number(100));
  command
      .add_option("--repeats", flags.repeats,
                  std::string("run every cell that often; default: ") + (plan ? "as FILE says, else once" : "once"))
      ->check(number_within(1, 1000));
  command.add_option("--sbatch", order.sbatch, "option for sbatch, repeatable: --sbatch=--time=60")
      ->allow_extra_args(false);
  command.add_option("--cell", flags.cell, "cell to run alone: used by the jobs of --on slurm")->group("");
  command.add_flag("--quiet", order.run.quiet, "no progress, no warnings");
}

void add_paper_command(CLI::App& bench, const std::shared_ptr<BenchFlags>& flags, const char* name, const char* help,
                       const char* footer) {
  CLI::App* command = bench.add_subcommand(name, help);
  command->footer(footer);
  command->add_option("ROOT", flags->root, "folder of the data set")->required()->check(path_given());
  command->add_option("--config", flags->config_file, "YAML configuration")->check(path_given());
  command->add_option("--set", flags->settings, "key=value, repeatable; overrides the file")->allow_extra_args(false);
  add_common_flags(*command, *flags, false);
}

void add_show_command(CLI::App& bench, const std::shared_ptr<BenchFlags>& flags) {
  CLI::App* command = bench.add_subcommand("show", "tables of an earlier benchmark");
  command->footer(kShowFooter);
  command->add_option("STORE", flags->root, "results.sqlite, or the folder it lies in")
      ->required()
      ->check(path_given());
  command->add_option("--format", flags->format, "text (default), markdown, csv")
      ->check(CLI::IsMember({"text", "markdown", "csv"}));
  command->add_flag("--paired", flags->paired, "the paired comparison with the peers alone");
  command->add_flag("--no-times", flags->no_times,
                    "omit the columns of time and memory: the rest is the same on every machine");
}

void check_order(const BenchFlags& flags) {
  const BenchOrder& order = flags.order;
  if (order.out.empty() && (order.on_slurm || flags.cell)) {
    throw RunError(RunErrorKind::kUsage,
                   "bench: --on slurm needs --out, a folder on a file system that the nodes share");
  }
  if (!order.on_slurm && !order.sbatch.empty()) {
    throw RunError(RunErrorKind::kUsage, "bench: --sbatch goes with --on slurm");
  }
}

int run_jobs(const BenchFlags& flags, std::vector<BenchJob> jobs) {
  return flags.cell ? run_bench_cell(flags.order, jobs, *flags.cell) : run_bench(flags.order, std::move(jobs));
}

int bench_command(const CLI::App& command, BenchFlags& flags) {
  const auto chosen = command.get_subcommands();
  if (!chosen.empty()) {
    const std::string name = chosen.front()->get_name();
    if (!flags.plan.empty() || !flags.data.empty() || command.count("--root") > 0) {
      throw RunError(RunErrorKind::kUsage,
                     "bench: FILE, --root and --data do not go with " + name + ". See: rilo bench --help");
    }
    if (name == "show") {
      show_bench(flags.root, {flags.format, flags.paired, !flags.no_times});
      return kSuccess;
    }
    check_order(flags);
    return run_jobs(flags, paper_jobs(flags, name == "kitti" ? PaperTables::kKitti : PaperTables::kM2dgr));
  }
  if (flags.plan.empty())
    throw RunError(RunErrorKind::kUsage,
                   "bench: FILE is required: it names the configurations, also with --data. See: rilo bench --help");
  check_order(flags);
  return run_jobs(flags, plan_jobs(flags));
}

}  // namespace

void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_code) {
  auto flags = std::make_shared<BenchFlags>();
  flags->order.command_line = command_line;
  CLI::App* command = app.add_subcommand("bench", "several configurations on several sequences");
  command->footer(kBenchFooter);
  command->add_option("FILE", flags->plan, "YAML with sequences and configurations")->check(path_given());
  command->add_option("--root", flags->root, "folder that the paths of FILE's sequences count from; default: FILE's")
      ->check(path_given());
  command->add_option("--data", flags->data, "folders or files with sweeps, in the place of FILE's sequences")
      ->check(path_given());
  command
      ->add_option("--peer", flags->peers,
                   "NAME=FILE, repeatable: poses by another program, compared on the same sweeps; {sequence} in FILE "
                   "is replaced by the name of each sequence")
      ->allow_extra_args(false);
  command
      ->add_option("--peer-figures", flags->peer_figures,
                   "CSV with figures of other programs: columns drive, peer, t_rel_pct and more")
      ->check(path_given());
  add_common_flags(*command, *flags, true);
  add_source_flags(*command, flags->order.run.source);
  add_paper_command(*command, flags, "kitti", "the paper's Tables I and II", kKittiFooter);
  add_paper_command(*command, flags, "m2dgr", "the paper's Table III", kM2dgrFooter);
  add_show_command(*command, flags);
  command->require_subcommand(0, 1);
  command->callback([flags, command, &exit_code] { exit_code = bench_command(*command, *flags); });
}

}  // namespace rilo::cli
