// results.json of rilo bench as a report shows it.
#pragma once

#include <filesystem>

#include "rilo/report/experiment_report.hpp"

namespace rilo::cli {

/// Whether `path` is such a file, or a folder with one.
bool is_saved_bench(const std::filesystem::path& path);

/// @throws IoError when it is no results.json of a benchmark, or holds no cell.
ExperimentReport read_saved_bench(const std::filesystem::path& path);

}  // namespace rilo::cli
