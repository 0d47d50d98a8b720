#include "bench/runner.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "bench/output.hpp"
#include "bench/paired.hpp"
#include "bench/peer_figures.hpp"
#include "bench/pool.hpp"
#include "bench/saved_results.hpp"
#include "bench/slurm.hpp"
#include "console/folder_lock.hpp"
#include "console/interrupt.hpp"
#include "console/progress.hpp"
#include "console/text.hpp"
#include "io/temporary_folder.hpp"
#include "results/output_check.hpp"
#include "results/run_outputs.hpp"
#include "session/processors.hpp"

namespace rilo {

namespace {

using Clock = std::chrono::steady_clock;

// Writing all results again after each cell may take this share of the time.
constexpr int kShareOfWriting = 20;

std::string prepared(const std::string& out, const std::vector<BenchJob>& jobs) {
  if (!out.empty()) {
    check_results_folder(out);
    for (const BenchJob& job : jobs) check_apart(out, job.sequence.path);
  }
  OutputRequest outputs;
  outputs.out = out;
  prepare_outputs(outputs);
  return out;
}

std::string outcome_of(const BenchCell& cell) {
  if (cell.failed()) return "failed: " + cell.error;
  const auto t_rel = value_of(cell, bench_figure("t_rel_pct"));
  return t_rel ? fmt::format("t_rel {:.4f} %", *t_rel) : "done";
}

class BenchRunner {
 public:
  BenchRunner(const BenchOrder& order, const std::vector<BenchJob>& jobs)
      : order_(order),
        jobs_(jobs),
        out_(prepared(order.out, jobs)),
        lock_(out_),
        temporary_(order.out.empty() ? std::make_optional<detail::TemporaryFolder>("rilo-bench") : std::nullopt),
        folder_(temporary_ ? temporary_->path() : std::filesystem::path(out_), !temporary_) {
    if (!order.baseline.empty()) baseline_ = read_saved_results(order.baseline);
  }

  int run() {
    const InterruptGuard guard;
    const std::vector<BenchJob> open = unfinished();
    if (!order_.run.quiet && open.size() < jobs_.size()) {
      std::cerr << fmt::format("{} of {} cells are finished already\n", finished_jobs(), jobs_.size());
    }
    if (!records_.empty()) write();
    progress_.emplace("cells", open.size(), order_.run.quiet);
    if (!open.empty()) run_all(open);
    progress_->finish();
    signal_ = finished_jobs() < jobs_.size() ? InterruptGuard::signal() : 0;
    const BenchOutput output = write();
    std::cout << (output.bench.cells.empty() ? "" : plain_text(all_tables(output)));
    return finish(output.bench);
  }

 private:
  // Jobs that are the same but for their names are run once.
  std::vector<BenchJob> unfinished() {
    std::vector<BenchJob> open;
    std::set<std::string> seen;
    for (const BenchJob& job : jobs_) {
      if (!seen.insert(job.key).second) continue;
      const auto record = folder_.read(job);
      if (record && !record->failed()) {
        records_.emplace(job.key, *record);
      } else {
        open.push_back(job);
      }
    }
    return open;
  }

  void run_all(const std::vector<BenchJob>& open) {
    const BenchEvents events{[this](const BenchJob& job) { started(job); },
                             [this](const BenchJob& job, const CellRecord& record) { finished(job, record); }};
    if (order_.on_slurm) {
      run_on_slurm(open, jobs_, folder_, {out_, order_.command_line, order_.sbatch, order_.at_a_time, order_.retries},
                   events);
      return;
    }
    BenchRunOptions flags = order_.run;
    const std::size_t at_a_time = std::max<std::size_t>(1, order_.at_a_time);
    if (flags.threads < 0 && at_a_time > 1) {
      flags.threads = std::max(1, usable_processors() / static_cast<int>(at_a_time));
    }
    run_in_pool(open, folder_, flags, {at_a_time, order_.retries}, events);
  }

  void started(const BenchJob& job) {
    running_.insert(job.name());
    show_progress();
  }

  void finished(const BenchJob& job, const CellRecord& record) {
    records_.insert_or_assign(job.key, record);
    running_.erase(job.name());
    ++done_;
    const BenchCell& cell = record.cells.front();
    progress_->say(fmt::format("[{}/{}] {}: {}", finished_jobs(), jobs_.size(), job.name(), outcome_of(cell)));
    show_progress();
    if (Clock::now() - written_ >= kShareOfWriting * writing_took_) write();
  }

  void show_progress() {
    progress_->update(done_, running_.empty() ? "" : fmt::format("{} running: {}", running_.size(), *running_.begin()));
  }

  std::size_t finished_jobs() const {
    return static_cast<std::size_t>(
        std::count_if(jobs_.begin(), jobs_.end(), [&](const BenchJob& job) { return records_.count(job.key) > 0; }));
  }

  // In the order of the plan, whichever came first. Peers are those of the first configuration that succeeded.
  BenchStore store() const {
    BenchStore store;
    store.tables = order_.tables;
    store.bench.command_line = order_.command_line;
    store.bench.planned = jobs_.size();
    store.bench.run = finished_jobs();
    store.bench.signal = signal_;
    store.bench.count = order_.run.count;
    std::set<std::string> peers_done;
    for (std::size_t i = 0; i < jobs_.size(); ++i) {
      const std::string& sequence = jobs_[i].sequence.name;
      const auto record = records_.find(jobs_[i].key);
      if (record != records_.end()) add_cells(jobs_[i], record->second, peers_done, store);
      const bool last = i + 1 == jobs_.size() || jobs_[i + 1].sequence.name != sequence;
      const bool any = !store.cells.empty() && store.cells.back().cell.sequence == sequence;
      if (last && any) add_peer_figures(order_.peer_figures, sequence, order_.run.count == 0, store.cells);
    }
    if (store.bench.run == jobs_.size()) add_missing_peers(peers_done, store);
    return store;
  }

  static void add_cells(const BenchJob& job, const CellRecord& record, std::set<std::string>& peers_done,
                        BenchStore& store) {
    for (BenchCell cell : record.cells) {
      cell.sequence = job.sequence.name;
      cell.group = job.sequence.group;
      if (!cell.peer) {
        cell.configuration = job.configuration.name;
        cell.settings = job.configuration.settings;
        cell.log = record.log;
        cell.repeat = job.repeat;
      } else if (peers_done.count(job.sequence.name) > 0) {
        break;
      }
      store.cells.push_back({cell, job.key, record.attempts, record.host});
    }
    if (!record.failed()) peers_done.insert(job.sequence.name);
  }

  // Which sweeps to compare is only known from a run.
  void add_missing_peers(std::set<std::string>& peers_done, BenchStore& store) const {
    for (const BenchJob& job : jobs_) {
      if (!peers_done.insert(job.sequence.name).second) continue;
      for (const BenchPeer& peer : job.sequence.peers) {
        BenchCell cell;
        cell.sequence = job.sequence.name;
        cell.configuration = peer.name;
        cell.peer = true;
        cell.settings = {peer.poses.string()};
        cell.error = "no configuration could be run on this sequence";
        cell.error_code = kBadData;
        store.cells.push_back({cell, job.key, 1, ""});
      }
    }
  }

  // After each cell: whatever ends the program, what is finished is there.
  BenchOutput write() {
    const auto begin = Clock::now();
    const BenchStore all = store();
    BenchOutput output = bench_output(all);
    output.baseline = baseline_;
    output.baseline_file = order_.baseline;
    if (!out_.empty()) write_results(out_, output, all);
    written_ = Clock::now();
    writing_took_ = written_ - begin;
    return output;
  }

  int finish(const BenchRecord& bench) const {
    if (!out_.empty() && !order_.run.quiet) std::cout << "\nresults in " << out_ << '\n';
    if (bench.signal != 0) {
      std::cerr << fmt::format("rilo: interrupted, {} of {} cells are finished\n", bench.run, bench.planned);
      return kSignalBase + bench.signal;
    }
    const auto failed = std::count_if(bench.cells.begin(), bench.cells.end(), [](const auto& c) { return c.failed(); });
    const auto first = std::find_if(bench.cells.begin(), bench.cells.end(), [](const auto& c) { return c.failed(); });
    if (first == bench.cells.end()) return kSuccess;
    throw RunError(kind_of(first->error_code),
                   fmt::format("{} of {} failed; the first: {} × {}: {}", failed, counted(bench.cells.size(), "cell"),
                               first->sequence, first->configuration, first->error));
  }

  const BenchOrder& order_;
  const std::vector<BenchJob>& jobs_;
  std::string out_;
  FolderLock lock_;
  std::optional<detail::TemporaryFolder> temporary_;
  CellFolder folder_;
  nlohmann::json baseline_;
  std::map<std::string, CellRecord> records_;  // by key
  std::optional<Progress> progress_;
  std::set<std::string> running_;
  std::size_t done_ = 0;  // by this process
  int signal_ = 0;
  Clock::time_point written_{};  // long ago
  Clock::duration writing_took_{};
};

}  // namespace

int run_bench(const BenchOrder& order, std::vector<BenchJob> jobs) {
  describe(jobs, order.run, order.out);
  return BenchRunner(order, jobs).run();
}

int run_bench_cell(const BenchOrder& order, const std::vector<BenchJob>& jobs, std::size_t number) {
  if (number >= jobs.size())
    throw RunError(RunErrorKind::kUsage, fmt::format("--cell {}: {}", number, counted(jobs.size(), "cell")));
  std::vector<BenchJob> job = {jobs[number]};
  BenchRunOptions flags = order.run;
  const char* processors = std::getenv("SLURM_CPUS_PER_TASK");
  if (flags.threads < 0) flags.threads = processors == nullptr ? 1 : std::max(1, std::atoi(processors));
  describe(job, flags, order.out);
  const CellFolder folder(order.out, true);
  check_submitted(order.out, number, job.front(), folder);
  int code = kSuccess;
  const InterruptGuard guard;
  const BenchEvents events{
      {}, [&](const BenchJob& /*job*/, const CellRecord& record) { code = record.cells.front().error_code; }};
  run_in_pool(job, folder, flags, {}, events);
  return InterruptGuard::signal() == 0 ? code : kSignalBase + InterruptGuard::signal();
}

void show_bench(const std::string& place, const BenchView& view) {
  const BenchOutput output = bench_output(read_store(place));
  const auto measured = view.with_times ? MeasuredColumns::kWith : MeasuredColumns::kWithout;
  if (view.format == "csv") {
    const std::vector<BenchCell>& cells = output.bench.cells;
    std::cout << (view.paired ? paired_csv(cells) : bench_csv(cells, measured)).csv();
  } else {
    const auto tables = view.paired ? paired_tables(output.bench.cells) : all_tables(output, measured);
    if (tables.empty()) std::cerr << "rilo: note: there are no peers in it\n";
    std::cout << (view.format == "markdown" ? markdown_text(tables) : plain_text(tables));
  }
}

}  // namespace rilo
