// rilo bench: several configurations on several sequences.
#include <iostream>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench_baseline.hpp"
#include "bench_paper.hpp"
#include "bench_process.hpp"
#include "checks.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/atomic_file.hpp"
#include "rilo/io/io_error.hpp"
#include "run_outputs.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kBenchFooter =
    R"(FILE lists sequences and configurations; each configuration is run on each sequence, one after the other. See
docs/bench.md for its keys. A cell that fails is reported, the others still run (exit code 3 at the end, or that of the
first failure). Ctrl-C ends the benchmark and writes what is finished.

  configurations:
    - name: full
    - name: A, no coarse registration
      set: [coarse.enabled=false]

Leaves in --out: results.json, results.csv, results.md.

Examples:
  rilo bench experiments/ablation.yaml --root drives --out results
  rilo bench experiments/ablation.yaml --data drives/a drives/b
  rilo bench my.yaml --count 200 --baseline results/results.json
  rilo bench kitti data/kitti --out results/kitti
  rilo bench m2dgr data/m2dgr)";

constexpr const char* kKittiFooter =
    R"(ROOT/sequences/00/velodyne …, ROOT/sequences/00/calib.txt and ROOT/poses/00.txt as in the KITTI odometry data set;
those of 00 … 10 that exist are run, each three times: with elevation corrections of 0 and of 0.205 degrees, both with
elevation.enabled=false as the paper has nothing like it, and as Rilo runs by default, with its own estimate.

Example:
  rilo bench kitti data/kitti --out results/kitti)";

constexpr const char* kM2dgrFooter =
    R"(Each sequence is a folder ROOT/NAME/ of sweeps that rilo run can open (.pcd, .ply or .bin, with stamps in times.txt
or in the files' names), with its true poses in ROOT/NAME.txt (TUM form, as M2DGR provides them). A bag ROOT/NAME.bag
without such a folder fails with the reason: unpack it. hall_01, hall_02, hall_03, room_01, door_01 and lift_01 are those
of the paper's table.

Example:
  rilo bench m2dgr data/m2dgr --out results/m2dgr)";

struct BenchFlags {
  std::string plan;
  std::vector<std::string> data;
  std::string root;  // of the plan's sequences, or of the data set
  std::string out;
  std::string baseline;
  std::string config_file;
  std::vector<std::string> settings;
  std::string command_line;
  BenchRunFlags run;
};

using Tables = std::vector<TitledTable>;
using PaperTables = Tables (*)(const std::vector<BenchCell>&);

// Data of the command line in the place of the plan's.
std::vector<BenchSequence> sequences_of(const BenchPlan& plan, const BenchFlags& flags) {
  if (flags.data.empty() && plan.sequences.empty()) {
    throw CommandError(kUsage, flags.plan + ": no sequences: in it; expected them there or folders after --data");
  }
  if (flags.data.empty()) return plan.sequences;
  std::vector<BenchSequence> sequences;
  std::set<std::string> names;
  for (const std::string& path : flags.data) {
    BenchSequence sequence;
    sequence.path = path;
    sequence.name = valid_utf8(last_name(path));
    if (!names.insert(sequence.name).second) sequence.name = valid_utf8(path);
    sequences.push_back(sequence);
  }
  return sequences;
}

std::vector<BenchJob> plan_jobs(const BenchFlags& flags) {
  const BenchPlan plan = load_bench_plan(flags.plan, flags.root);
  std::vector<BenchJob> jobs;
  for (const BenchSequence& sequence : sequences_of(plan, flags)) {
    for (const BenchConfiguration& configuration : plan.configurations) jobs.push_back({sequence, configuration});
  }
  return jobs;
}

// Of the command line, for KITTI and M2DGR.
BenchConfiguration configuration_of(const BenchFlags& flags) {
  BenchConfiguration result{"rilo", {}, flags.settings};
  if (!flags.config_file.empty()) {
    result.config = load_config(flags.config_file);
    result.settings.insert(result.settings.begin(), "config " + last_name(flags.config_file));
  }
  result.config = with_overrides(result.config, flags.settings);
  return result;
}

class Bench {
 public:
  Bench(const BenchFlags& flags, PaperTables paper) : flags_(flags), paper_(paper) {
    bench_.command_line = flags.command_line;
    if (!flags.baseline.empty()) baseline_ = read_baseline(flags.baseline);
    RunFlags outputs;
    outputs.out = flags.out;
    prepare_outputs(outputs);
  }

  int run(const std::vector<BenchJob>& jobs) {
    bench_.planned = jobs.size();
    {
      const InterruptGuard guard;
      for (std::size_t i = 0; i < jobs.size() && InterruptGuard::signal() == 0; ++i) run_job(jobs[i]);
      bench_.signal = bench_.run < jobs.size() ? InterruptGuard::signal() : 0;
      if (bench_.signal == 0) add_missing_peers(jobs);
      write();
    }
    std::cout << (bench_.cells.empty() ? "" : plain_text(tables()));
    return finish();
  }

 private:
  void run_job(const BenchJob& job) {
    const std::string name = fmt::format("{} × {}", job.sequence.name, job.configuration.name);
    if (!flags_.run.quiet) std::cerr << fmt::format("[{}/{}] {}\n", bench_.run + 1, bench_.planned, name);
    const bool with_peers = peers_done_.count(job.sequence.name) == 0;
    const std::vector<BenchCell> cells = run_cell_apart(job.sequence, job.configuration, flags_.run, with_peers);
    if (cells.empty()) return;  // interrupted
    ++bench_.run;
    if (cells.front().failed()) {
      if (!flags_.run.quiet) std::cerr << "failed: " << cells.front().error << '\n';
    } else {
      peers_done_.insert(job.sequence.name);
    }
    bench_.cells.insert(bench_.cells.end(), cells.begin(), cells.end());
    write();
  }

  // Which sweeps to compare is only known from a run.
  void add_missing_peers(const std::vector<BenchJob>& jobs) {
    for (const BenchJob& job : jobs) {
      if (!peers_done_.insert(job.sequence.name).second) continue;
      for (const BenchPeer& peer : job.sequence.peers) {
        bench_.cells.push_back({job.sequence.name,
                                peer.name,
                                true,
                                {peer.poses.string()},
                                {},
                                {},
                                "no configuration could be run on this sequence",
                                kBadData});
      }
    }
  }

  Tables tables() const {
    Tables tables = bench_tables(bench_.cells);
    if (paper_ != nullptr) {
      const Tables paper = paper_(bench_.cells);
      tables.insert(tables.end(), paper.begin(), paper.end());
    }
    if (!baseline_.is_null()) tables.push_back(baseline_table(bench_.cells, baseline_, flags_.baseline));
    return tables;
  }

  // After each cell: whatever ends the program, what is finished is there.
  void write() const {
    if (flags_.out.empty()) return;
    const std::filesystem::path folder = flags_.out;
    try {
      write_atomically(folder / "results.json", json_text(results_json(bench_)));
      write_atomically(folder / "results.csv", bench_csv(bench_.cells).csv());
      write_atomically(folder / "results.md", "# " + bench_.command_line + "\n\n" + markdown_text(tables()));
    } catch (const IoError& error) {
      throw CommandError(kCannotWrite, error.what());
    }
  }

  int finish() const {
    if (!flags_.out.empty() && !flags_.run.quiet) std::cout << "\nresults in " << flags_.out << '\n';
    if (bench_.signal != 0) {
      std::cerr << fmt::format("rilo: interrupted, {} of {} cells are finished\n", bench_.run, bench_.planned);
      return kSignalBase + bench_.signal;
    }
    std::size_t failed = 0;
    const BenchCell* first = nullptr;
    for (const BenchCell& cell : bench_.cells) {
      failed += cell.failed() ? 1 : 0;
      if (cell.failed() && first == nullptr) first = &cell;
    }
    if (first == nullptr) return kSuccess;
    throw CommandError(first->error_code, fmt::format("{} of {} failed; the first: {} × {}: {}", failed,
                                                      counted(bench_.cells.size(), "cell"), first->sequence,
                                                      first->configuration, first->error));
  }

  const BenchFlags& flags_;
  PaperTables paper_;
  BenchRecord bench_;
  nlohmann::json baseline_;
  std::set<std::string> peers_done_;
};

void add_common_flags(CLI::App& command, BenchFlags& flags) {
  command.add_option("--out", flags.out, "folder for the results (created)")->check(path_given());
  command.add_option("--baseline", flags.baseline, "results.json of an earlier benchmark to print the difference to")
      ->check(path_given());
  command.add_option("--count", flags.run.count, "run that many sweeps of every sequence; 0: all, or as FILE says")
      ->check(whole_number());
  command.add_option("--threads", flags.run.threads, "threads; 0: as many as the machine has. Default: as configured")
      ->check(whole_number(1024));
  command.add_flag("--quiet", flags.run.quiet, "no progress, no warnings");
}

void add_paper_command(CLI::App& bench, const std::shared_ptr<BenchFlags>& flags, const char* name, const char* help,
                       const char* footer) {
  CLI::App* command = bench.add_subcommand(name, help);
  command->footer(footer);
  command->add_option("ROOT", flags->root, "folder of the data set")->required()->check(path_given());
  command->add_option("--config", flags->config_file, "YAML configuration")->check(path_given());
  command->add_option("--set", flags->settings, "key=value, repeatable; overrides the file")->allow_extra_args(false);
  add_common_flags(*command, *flags);
}

int bench_command(const CLI::App& command, const BenchFlags& flags) {
  if (command.got_subcommand("kitti") || command.got_subcommand("m2dgr")) {
    if (!flags.plan.empty() || !flags.data.empty() || command.count("--root") > 0) {
      throw CommandError(kUsage,
                         "bench: FILE, --root and --data do not go with kitti or m2dgr. See: rilo bench --help");
    }
    const bool kitti = command.got_subcommand("kitti");
    const BenchConfiguration configuration = configuration_of(flags);
    const auto jobs = kitti ? kitti_jobs(flags.root, configuration) : m2dgr_jobs(flags.root, configuration);
    return Bench(flags, kitti ? kitti_tables : m2dgr_tables).run(jobs);
  }
  if (flags.plan.empty()) throw CommandError(kUsage, "bench: FILE is required. See: rilo bench --help");
  return Bench(flags, nullptr).run(plan_jobs(flags));
}

}  // namespace

void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_code) {
  auto flags = std::make_shared<BenchFlags>();
  flags->command_line = command_line;
  CLI::App* command = app.add_subcommand("bench", "several configurations on several sequences");
  command->footer(kBenchFooter);
  command->add_option("FILE", flags->plan, "YAML with sequences and configurations")->check(path_given());
  command->add_option("--root", flags->root, "folder that the paths of FILE's sequences count from; default: FILE's")
      ->check(path_given());
  command->add_option("--data", flags->data, "folders or files with sweeps, in the place of FILE's sequences")
      ->check(path_given());
  add_common_flags(*command, *flags);
  add_source_flags(*command, flags->run.source);
  add_paper_command(*command, flags, "kitti", "the paper's Tables I and II", kKittiFooter);
  add_paper_command(*command, flags, "m2dgr", "the paper's Table III", kM2dgrFooter);
  command->require_subcommand(0, 1);
  command->callback([flags, command, &exit_code] { exit_code = bench_command(*command, *flags); });
}

}  // namespace rilo::cli
