#include <algorithm>

#include <fmt/format.h>

#include "rilo/config/config_file.hpp"
#include "rilo/config/odometry_keys.hpp"

namespace rilo {
namespace {

// "m, 0 … 100: what it does"
std::string comment_of(const ConfigKey& key) {
  const std::string unit = key.unit().empty() ? "" : key.unit() + ", ";
  return fmt::format("{}{}: {}", unit, key.allowed(), key.meaning());
}

}  // namespace

std::string dump_config(const OdometryConfig& config) {
  OdometryConfig copy = config;
  const ConfigKeys keys = odometry_keys(copy);
  std::string text = "# Configuration of the odometry. Behind each value: unit, allowed values, meaning.\n";
  for (const ConfigSection& section : keys.sections()) {
    const std::string indent = section.name.empty() ? "" : "  ";
    std::vector<std::string> entries;
    std::size_t width = 0;
    for (const ConfigKey& key : section.keys) {
      entries.push_back(fmt::format("{}{}: {}", indent, key.last_name(), key.value()));
      width = std::max(width, entries.back().size());
    }
    if (!section.name.empty()) text += fmt::format("\n# {}\n{}:\n", section.meaning, section.name);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      text += fmt::format("{:<{}}  # {}\n", entries[i], width, comment_of(section.keys[i]));
    }
  }
  return text;
}

std::string config_markdown(const OdometryConfig& config) {
  OdometryConfig copy = config;
  const ConfigKeys keys = odometry_keys(copy);
  std::string text;
  for (const ConfigSection& section : keys.sections()) {
    if (!section.name.empty()) text += fmt::format("\n### {}\n\n{}.\n\n", section.name, section.meaning);
    text += "| key | default | unit | allowed | meaning |\n|---|---|---|---|---|\n";
    for (const ConfigKey& key : section.keys) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name(), key.value(), key.unit(), key.allowed(),
                          key.meaning());
    }
  }
  return text;
}

}  // namespace rilo
