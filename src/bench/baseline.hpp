// Differences to an earlier benchmark.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "bench/tables.hpp"

namespace rilo {

/// New minus old for each cell that both have; cells of only one are named in the note. `baseline`: its results.json.
TitledTable baseline_table(const std::vector<BenchCell>& cells, const nlohmann::json& baseline,
                           const std::filesystem::path& file);

}  // namespace rilo
