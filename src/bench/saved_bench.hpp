// Results of rilo bench as a report shows them.
#pragma once

#include <filesystem>

#include "report/experiment_report.hpp"

namespace rilo {

/// `path` as in read_saved_results(). @throws IoError when it is not a benchmark's, or holds no cell.
ExperimentReport read_saved_bench(const std::filesystem::path& path);

}  // namespace rilo
