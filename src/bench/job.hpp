// What a benchmark has to do: one configuration on one sequence, as often as requested.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/cell.hpp"

namespace rilo {

/// A cell to run.
struct BenchJob {
  BenchSequence sequence;
  BenchConfiguration configuration;
  std::size_t repeat = 1;           ///< counted from 1
  std::size_t repeats = 1;          ///< of this cell
  nlohmann::json description = {};  ///< all that the result depends on; see describe()
  std::string key = {};             ///< of the description; names the cell's files

  /// "urban00 × full", with the repeat where there are several.
  std::string name() const;
};

/// Every configuration on every sequence, `plan.repeats` times each; without descriptions.
std::vector<BenchJob> jobs_of(const BenchPlan& plan);

/// Jobs that were made without repeats, `repeats` times each.
std::vector<BenchJob> repeated(const std::vector<BenchJob>& jobs, std::size_t repeats);

/// Fills in descriptions and keys: data, truth, peers, how the data are read, configuration, program. Neither names nor
/// the number of threads count, on which no result depends. `results`: the folder that the benchmark writes to, which
/// may lie within the data.
void describe(std::vector<BenchJob>& jobs, const BenchRunOptions& flags, const std::filesystem::path& results);

}  // namespace rilo
