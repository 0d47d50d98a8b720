// JSON files of our own: RunMetrics and back, by one list of keys.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "results/metrics.hpp"

namespace rilo {

/// What is empty is null in kAll and absent in kSparse (of a peer, little is known).
enum class MetricKeys : std::uint8_t { kAll, kSparse };

nlohmann::json to_json(const RunMetrics& metrics, MetricKeys keys = MetricKeys::kAll);
nlohmann::json to_json(const EvaluationMetrics& metrics);
nlohmann::json to_json(const TrialMetrics& metrics);
nlohmann::json to_json(const StampFaults& faults);

/// The object in `file`. `expected` and `remedy` are parts of the message.
/// @throws IoError when it cannot be read, is not JSON or not an object.
nlohmann::json read_json_object(const std::filesystem::path& file, const std::string& expected,
                                const std::string& remedy);

/// Keys that are missing or null leave their field empty; unknown ones are ignored. `file`: for messages.
/// @throws IoError when a value is of another type than its key has.
RunMetrics metrics_of(const nlohmann::json& json, const std::filesystem::path& file);

}  // namespace rilo
