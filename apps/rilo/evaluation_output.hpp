// Errors against ground truth, as JSON and as text.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "rilo/evaluation/evaluation.hpp"

namespace rilo::cli {

/// Figures of one sequence; units in the names.
nlohmann::json evaluation_json(const Evaluation& evaluation);

/// A small table with the protocol of each figure.
std::string evaluation_table(const Evaluation& evaluation);

}  // namespace rilo::cli
