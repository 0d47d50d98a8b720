#include "bench/sensitivity.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "config/bench_plan.hpp"
#include "io/text.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {

namespace {

using Settings = std::map<std::string, std::string>;

/// The last value of a key counts, as on the command line, whichever of its names it has; what is not "key=value" is a
/// key of its own.
Settings map_of(const std::vector<std::string>& settings) {
  OdometryConfig config;
  const ConfigKeys keys = odometry_keys(config);
  Settings result;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const ConfigKey* key = keys.find(name);
    result[key == nullptr ? name : key->name()] = equals == std::string::npos ? "" : setting.substr(equals + 1);
  }
  return result;
}

/// The value of a key that `settings` may set. Nothing where their file may, which need not be there any more.
std::optional<double> value_in(const Settings& settings, const std::string& key) {
  if (const auto own = settings.find(key); own != settings.end()) return detail::parse_double(own->second);
  OdometryConfig config;
  const ConfigKeys keys = odometry_keys(config);
  const bool from_file = std::any_of(settings.begin(), settings.end(),
                                     [](const auto& entry) { return entry.first.starts_with(kConfigWord); });
  const ConfigKey* found = keys.find(key);
  return from_file || found == nullptr ? std::nullopt : detail::parse_double(found->value());
}

struct Change {
  std::string key;
  double value = 0;
};

/// The one numeric key that `other` sets on top of `base`, or sets otherwise.
std::optional<Change> single_change(const Settings& base, const Settings& other) {
  std::optional<Change> change;
  for (const auto& [key, text] : other) {
    const auto known = base.find(key);
    if (known != base.end() && known->second == text) continue;
    const auto value = detail::parse_double(text);
    if (change || !value) return std::nullopt;
    change = Change{key, *value};
  }
  const bool all_kept =
      std::all_of(base.begin(), base.end(), [&](const auto& entry) { return other.contains(entry.first); });
  return all_kept ? change : std::nullopt;
}

}  // namespace

void add_settings(const std::string& configuration, const nlohmann::json& cell,
                  std::vector<ConfigurationSettings>& all) {
  const bool known =
      std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.first == configuration; });
  if (known) return;
  all.emplace_back(configuration, std::vector<std::string>());
  if (!cell.contains("settings") || !cell["settings"].is_array()) return;
  for (const nlohmann::json& setting : cell["settings"]) {
    if (setting.is_string()) all.back().second.push_back(setting);
  }
}

std::vector<SensitivitySeries> find_sensitivities(const std::vector<ConfigurationSettings>& all) {
  constexpr std::size_t kLeastPoints = 3;
  std::map<std::string, SensitivitySeries> best;  // by key: the base with the most values
  for (const auto& [name, settings] : all) {
    const auto base = map_of(settings);
    std::map<std::string, SensitivitySeries> found;
    for (const auto& [other, other_settings] : all) {
      const auto change = other == name ? std::nullopt : single_change(base, map_of(other_settings));
      if (change) found[change->key].points.emplace_back(change->value, other);
    }
    for (auto& [key, series] : found) {
      const auto value = value_in(base, key);
      if (!value) continue;
      series.points.emplace_back(*value, name);
      std::sort(series.points.begin(), series.points.end());
      series.key = key;
      series.base = name;
      if (series.points.size() >= kLeastPoints && series.points.size() > best[key].points.size()) best[key] = series;
    }
  }
  std::vector<SensitivitySeries> result;
  for (auto& [key, series] : best) {
    if (!series.points.empty()) result.push_back(std::move(series));
  }
  return result;
}

}  // namespace rilo
