#include "bench/slurm.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "bench/content_hash.hpp"
#include "bench/slurm_commands.hpp"
#include "console/interrupt.hpp"
#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "results/run_outputs.hpp"

namespace rilo {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestArray = 1000;  // Slurm's own limit, unless configured, is 1001
constexpr std::chrono::milliseconds kShortestLook{500};
constexpr std::chrono::milliseconds kLongestLook{10'000};
constexpr std::chrono::milliseconds kSignalLook{50};
// A file of another machine may show late.
constexpr std::chrono::seconds kFileOfCompleted{60};
constexpr std::chrono::seconds kFileOfFailed{3};
constexpr int kMostQueueFailures = 60;

fs::path folder_of(const fs::path& out) { return out / "slurm"; }
fs::path keys_file(const fs::path& out) { return folder_of(out) / "keys.txt"; }

// The command line again, in the same folder, for the cell of the task.
std::string script_for(const SlurmOrder& order, std::size_t offset) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const std::string arguments = order.command_line.substr(order.command_line.find(' ') + 1);
  return fmt::format(
      "#!/bin/sh\n# Written by rilo bench --on slurm.\ncd {} || exit 3\n"
      "exec {} {} --cell \"$((SLURM_ARRAY_TASK_ID + {}))\"\n",
      shell_quoted(fs::current_path().string()), shell_quoted(program), arguments, offset);
}

class SlurmRun {
 public:
  SlurmRun(const std::vector<BenchJob>& all, const CellFolder& folder, const SlurmOrder& order,
           const BenchEvents& events)
      : all_(all),
        folder_(folder),
        order_(order),
        events_(events),
        name_("rilo-" + hash_of(fs::canonical(order.out).string()).substr(0, 10)) {}

  void run(const std::vector<BenchJob>& open) {
    for (const BenchJob& job : open) open_.insert(number_of(job));
    adopt();
    write_inputs();
    submit();
    while (!open_.empty() && InterruptGuard::signal() == 0) {
      pause();
      look();
      submit_again();
    }
    if (InterruptGuard::signal() != 0) cancel();
  }

 private:
  struct Flight {
    SlurmTask task;
    bool running = false;
    bool adopted = false;
    Clock::time_point gone{};  // when it was first missing in the queue
    std::string end;           // its state then
  };

  std::size_t number_of(const BenchJob& job) const {
    return static_cast<std::size_t>(
        std::find_if(all_.begin(), all_.end(), [&](const BenchJob& j) { return j.key == job.key; }) - all_.begin());
  }

  // Names are NAME-OFFSET: what a task's cell is can be read off the queue alone.
  std::string name_at(std::size_t offset) const { return fmt::format("{}-{}", name_, offset); }
  std::size_t cell_of(const SlurmTask& task) const {
    const std::string offset = task.name.substr(std::min(task.name.size(), name_.size() + 1));
    return task.index + (offset.empty() ? 0 : std::strtoul(offset.c_str(), nullptr, 10));
  }

  // Of a call before, whose process is gone. Its tasks run the cells that they were submitted for.
  void adopt() {
    const auto tasks = tasks_in_queue(name_);
    if (!tasks)
      throw RunError(RunErrorKind::kUsage, "--on slurm: squeue fails; does the controller run? (scontrol ping)");
    for (const SlurmTask& task : *tasks) {
      if (open_.count(cell_of(task)) > 0) flights_[cell_of(task)] = {task, false, true, {}, ""};
    }
  }

  void write_inputs() const {
    std::string keys;
    for (const BenchJob& job : all_) keys += job.key + "\n";
    guard_writing([&] {
      create_folder(folder_of(order_.out));
      write_atomically(keys_file(order_.out), keys);
      for (std::size_t offset = 0; offset < all_.size(); offset += kLargestArray) {
        write_atomically(script_file(offset), script_for(order_, offset));
      }
    });
  }

  fs::path script_file(std::size_t offset) const { return folder_of(order_.out) / fmt::format("cells-{}.sh", offset); }

  // All open cells that are not in the queue. Each array has the limit by itself: with one, there is one array at a
  // time.
  void submit() {
    if (order_.at_a_time > 0 && !flights_.empty()) return;
    std::map<std::size_t, std::vector<std::size_t>> arrays;  // by offset
    for (const std::size_t cell : open_) {
      const std::size_t offset = cell / kLargestArray * kLargestArray;
      if (flights_.count(cell) > 0) continue;
      arrays[offset].push_back(cell - offset);
    }
    for (const auto& [offset, indices] : arrays) {
      // A failure of before: what will lie there is of the new task.
      for (const std::size_t index : indices) folder_.remove(all_[index + offset]);
      const std::string limit = order_.at_a_time > 0 ? fmt::format("%{}", order_.at_a_time) : "";
      const std::string array = submit_array(script_file(offset), name_at(offset), index_ranges(indices) + limit,
                                             folder_of(order_.out) / "%A_%a.log", order_.sbatch);
      for (const std::size_t index : indices) {
        flights_[index + offset] = {{array, index, "PENDING", name_at(offset)}, false, false, {}, ""};
        ++attempts_[index + offset];
      }
      if (order_.at_a_time > 0) return;
    }
  }

  // Such jobs were taken before: a rejection now is temporary, because of the controller or of a limit.
  void submit_again() {
    try {
      submit();
      rejections_ = 0;
    } catch (const RunError&) {
      if (++rejections_ > kMostQueueFailures) throw;
    }
  }

  // Often at first, rarely where cells take long; a signal ends it at once.
  void pause() {
    const auto until = Clock::now() + interval_;
    while (Clock::now() < until && InterruptGuard::signal() == 0) std::this_thread::sleep_for(kSignalLook);
    interval_ = std::min(interval_ * 5 / 4, kLongestLook);
  }

  void look() {
    const auto tasks = tasks_in_queue(name_);
    queue_failures_ = tasks ? 0 : queue_failures_ + 1;
    if (queue_failures_ > kMostQueueFailures) {
      throw RunError(RunErrorKind::kUnexpected,
                     "--on slurm: squeue fails; the jobs continue, and the same command waits for them");
    }
    if (!tasks) return;
    std::set<std::string> queued;
    for (const SlurmTask& task : *tasks) {
      if (task.state != "COMPLETED") queued.insert(task.id());
      const auto flight = flights_.find(cell_of(task));
      if (flight == flights_.end() || flight->second.running || task.state != "RUNNING") continue;
      flight->second.running = true;
      events_.started(all_[flight->first]);
    }
    const auto flights = flights_;  // take() changes them
    for (const auto& [cell, flight] : flights) {
      if (queued.count(flight.task.id()) == 0) leave(cell);
    }
  }

  // A task that is not in the queue any more.
  void leave(std::size_t cell) {
    Flight& flight = flights_[cell];
    if (const auto record = folder_.read(all_[cell])) return take(cell, *record);
    if (flight.end.empty()) {
      const std::string state = end_of_task(flight.task);
      if (!is_over(state)) return;
      flight.end = state;
      flight.gone = Clock::now();
    }
    const bool completed = flight.end == "COMPLETED";
    const bool failed = flight.end == "FAILED" || flight.end == "UNKNOWN";
    const auto patience = completed ? kFileOfCompleted : failed ? kFileOfFailed : std::chrono::seconds(0);
    if (Clock::now() - flight.gone < patience) {
      interval_ = kShortestLook;
      return;
    }
    const std::string log = fmt::format("slurm/{}.log", flight.task.id());
    take(cell, failed_record(all_[cell], folder_, attempts_[cell],
                             fmt::format("Slurm ended its task {} ({}) without a result, see {}", flight.task.id(),
                                         flight.end, log)));
  }

  void take(std::size_t cell, CellRecord record) {
    interval_ = kShortestLook;
    const bool again = record.failed() && (flights_[cell].adopted || attempts_[cell] <= order_.retries);
    flights_.erase(cell);
    if (again) return;
    record.attempts = std::max<std::size_t>(1, attempts_[cell]);
    open_.erase(cell);
    events_.finished(all_[cell], record);
  }

  void cancel() {
    std::vector<SlurmTask> tasks;
    for (const auto& [cell, flight] : flights_) tasks.push_back(flight.task);
    cancel_tasks(tasks);
  }

  const std::vector<BenchJob>& all_;
  const CellFolder& folder_;
  const SlurmOrder& order_;
  const BenchEvents& events_;
  std::string name_;
  std::set<std::size_t> open_;             // numbers of cells
  std::map<std::size_t, Flight> flights_;  // by cell
  std::map<std::size_t, std::size_t> attempts_;
  std::chrono::milliseconds interval_ = kShortestLook;
  int queue_failures_ = 0;
  int rejections_ = 0;  // by sbatch
};

}  // namespace

void run_on_slurm(const std::vector<BenchJob>& open, const std::vector<BenchJob>& all, const CellFolder& folder,
                  const SlurmOrder& order, const BenchEvents& events) {
  SlurmRun(all, folder, order, events).run(open);
}

void check_submitted(const fs::path& out, std::size_t number, const BenchJob& job, const CellFolder& folder) {
  std::ifstream keys(keys_file(out));
  std::string key;
  for (std::size_t i = 0; i <= number; ++i) std::getline(keys, key);
  if (keys && key == job.key) return;
  const std::string message = fmt::format(
      "{}: cell {} ({}) is not the one that was submitted: its data, its "
      "configuration or the program were changed. Run the benchmark again",
      out.string(), number, job.name());
  if (keys) {
    BenchJob submitted = job;
    submitted.key = key;
    failed_record(submitted, folder, 1, message, kBadData);
  }
  throw RunError(RunErrorKind::kBadData, message);
}

}  // namespace rilo
