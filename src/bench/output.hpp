// Results of a benchmark as text and as files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/store.hpp"
#include "bench/tables.hpp"

namespace rilo {

/// Results of a benchmark, repeats of a cell as one, and what they are compared with.
struct BenchOutput {
  BenchRecord bench;  ///< cells combined
  PaperTables tables = PaperTables::kNone;
  nlohmann::json baseline;  ///< null: none
  std::filesystem::path baseline_file;
};

/// Without a baseline.
BenchOutput bench_output(const BenchStore& store);

/// All tables, those of the paper and of the baseline included.
std::vector<TitledTable> all_tables(const BenchOutput& output, MeasuredColumns measured = MeasuredColumns::kWith);

/// results.md.
std::string bench_markdown(const BenchOutput& output, MeasuredColumns measured = MeasuredColumns::kWith);

/// Refuses a folder where that would replace files that no benchmark has left. @throws RunError, kCannotWrite
void check_results_folder(const std::filesystem::path& folder);

/// results.json, .csv, .md and .sqlite, each whole or not at all. @throws RunError, kCannotWrite
void write_results(const std::filesystem::path& folder, const BenchOutput& output, const BenchStore& store);

}  // namespace rilo
