// Which configurations of an experiment differ in one number alone.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "report/experiment_report.hpp"

namespace rilo {

/// Name and settings ("key=value", or "config NAME") of a configuration.
using ConfigurationSettings = std::pair<std::string, std::vector<std::string>>;

/// Adds `configuration` with the settings of a cell of results.json, unless it is there already.
void add_settings(const std::string& configuration, const nlohmann::json& cell,
                  std::vector<ConfigurationSettings>& all);

/// For each configuration that others extend by one numeric key: a series of that key, the base itself at the value
/// that it has there (its own, or the default; unknown where its file may set it: no series). Series of fewer than
/// three values show no trend and are omitted.
std::vector<SensitivitySeries> find_sensitivities(const std::vector<ConfigurationSettings>& all);

}  // namespace rilo
