#include <algorithm>

#include <fmt/format.h>

#include "rilo/config/config_file.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

// "[m, 0 … 100] meaning (source)"
std::string comment_of(const ConfigKey& key) {
  const std::string unit = key.unit().empty() ? "" : key.unit() + ", ";
  const std::string source = key.expert() ? " (" + key.source() + ")" : "";
  return fmt::format("[{}{}] {}{}", unit, key.allowed(), key.meaning(), source);
}

std::vector<ConfigKey> keys_of_tier(const ConfigSection& section, bool expert) {
  std::vector<ConfigKey> keys;
  std::copy_if(section.keys.begin(), section.keys.end(), std::back_inserter(keys),
               [&](const ConfigKey& key) { return key.expert() == expert; });
  return keys;
}

// The keys of one tier, section by section, each line indented by `indent`.
std::string dump_tier(const ConfigKeys& all, bool expert, const std::string& indent) {
  std::string text;
  for (const ConfigSection& section : all.sections()) {
    const std::vector<ConfigKey> keys = keys_of_tier(section, expert);
    if (keys.empty()) continue;
    const std::string deeper = indent + (section.name.empty() ? "" : "  ");
    std::vector<std::string> entries;
    std::size_t width = 0;
    for (const ConfigKey& key : keys) {
      entries.push_back(fmt::format("{}{}: {}", deeper, key.last_name(), key.value()));
      width = std::max(width, entries.back().size());
    }
    if (!section.name.empty()) text += fmt::format("\n{}# {}\n{}{}:\n", indent, section.meaning, indent, section.name);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      text += fmt::format("{:<{}}  # {}\n", entries[i], width, comment_of(keys[i]));
    }
  }
  return text;
}

}  // namespace

std::string dump_config(const OdometryConfig& config) {
  OdometryConfig copy = config;
  const ConfigKeys keys = odometry_keys(copy);
  std::string text = "# Configuration of the odometry. Behind each value: [unit, allowed values] meaning.\n";
  text += dump_tier(keys, false, "");
  text += fmt::format(
      "\n# For experiments with the method: no sensor and no robot needs another value. In parentheses, where it "
      "comes\n"
      "# from: a section of the paper (III-A ...) or a row of docs/experiments.md.\n{}:\n",
      kExpertSection);
  return text + dump_tier(keys, true, "  ");
}

std::string config_markdown(const OdometryConfig& config) {
  OdometryConfig copy = config;
  const ConfigKeys keys = odometry_keys(copy);
  std::string text = "| key | default | unit | allowed | meaning |\n|---|---|---|---|---|\n";
  for (const ConfigSection& section : keys.sections()) {
    for (const ConfigKey& key : keys_of_tier(section, false)) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name(), key.value(), key.unit(), key.allowed(),
                          key.meaning());
    }
  }
  return text;
}

}  // namespace rilo
