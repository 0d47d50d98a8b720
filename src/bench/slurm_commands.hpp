// Slurm as its commands present it: sbatch, squeue, sacct, scontrol, scancel.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rilo {

/// Runs a program to its end.
struct ProgramResult {
  int code = 0;     ///< of its exit; 127: it could not be started
  std::string out;  ///< standard output and error
};
ProgramResult run_program(const std::vector<std::string>& words);

/// A task of a job array.
struct SlurmTask {
  std::string array;      ///< number of the job array
  std::size_t index = 0;  ///< within the array
  std::string state;      ///< PENDING, RUNNING, …
  std::string name;       ///< of the job
  std::string id() const { return array + "_" + std::to_string(index); }
};

/// Lines "array|index|state|name" as our call of squeue gives them; others are ignored.
std::vector<SlurmTask> parse_queue(const std::string& text);

/// "0-2,5,7-8" of ascending numbers.
std::string index_ranges(const std::vector<std::size_t>& numbers);

/// Tasks of this user whose job's name begins with `name`; nothing when squeue fails (it may do so for a while).
std::optional<std::vector<SlurmTask>> tasks_in_queue(const std::string& name);

/// Submits `script` as an array. @returns its number. @throws RunError with what sbatch said.
std::string submit_array(const std::filesystem::path& script, const std::string& name, const std::string& indices,
                         const std::filesystem::path& log, const std::vector<std::string>& options);

/// What became of a task that is not in the queue any more, "TIMEOUT" and so on: from the accounting where there is
/// one, else from the controller, which remembers for some minutes. "UNKNOWN" when neither knows.
std::string end_of_task(const SlurmTask& task);

/// Whether a task in that state has come to its end. A list of the queue may lack one that has not: that is not enough.
bool is_over(const std::string& state);

void cancel_tasks(const std::vector<SlurmTask>& tasks);

}  // namespace rilo
