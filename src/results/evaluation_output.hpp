// Errors of a trajectory, for people and for scripts.
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "rilo/evaluation/evaluation.hpp"

namespace rilo {

std::string evaluation_table(const Evaluation& evaluation);

/// The two averages over sequences that the field prints.
nlohmann::json benchmark_json(const KittiBenchmark& benchmark);
std::string benchmark_table(const KittiBenchmark& benchmark, std::size_t sequences);

}  // namespace rilo
