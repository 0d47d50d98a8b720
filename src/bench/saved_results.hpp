// Results of an earlier benchmark, from whichever of its files is at hand.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "report/experiment_report.hpp"

namespace rilo {

/// Whether `path` is a results.json or results.sqlite by its name, or a folder with one.
bool is_saved_results(const std::filesystem::path& path);

/// The content of results.json. `path`: that file, the store results.sqlite, or the folder with either.
/// @throws IoError when it is none.
nlohmann::json read_saved_results(const std::filesystem::path& path);

/// The same as a report shows it. @throws IoError when it is not a benchmark's, or holds no cell.
ExperimentReport read_saved_bench(const std::filesystem::path& path);

}  // namespace rilo
