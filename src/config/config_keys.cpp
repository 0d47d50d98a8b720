#include <algorithm>
#include <utility>

#include "rilo/config/nearest_word.hpp"
#include "rilo/config/odometry_keys.hpp"

namespace rilo {
namespace {

// A key in the wrong section is still meant: its last part counts too, at a small price.
std::size_t unlikeness(std::string_view wanted, std::string_view known) {
  return std::min(edit_distance(wanted, known), edit_distance(last_part(wanted), last_part(known)) + 1);
}

}  // namespace

void ConfigKeys::add(std::string_view name, std::string_view unit, std::string_view meaning,
                     ConfigKey::Binding binding) {
  ConfigSection& section = sections_.back();
  std::string full = section.name.empty() ? std::string(name) : section.name + "." + std::string(name);
  section.keys.emplace_back(std::move(full), std::string(unit), std::string(meaning), std::move(binding));
}

void ConfigKeys::real(std::string_view name, double& member, double least, double most, std::string_view unit,
                      std::string_view meaning) {
  add(name, unit, meaning, ConfigKey::Real{&member, least, most});
}

void ConfigKeys::integer(std::string_view name, int& member, int least, int most, std::string_view unit,
                         std::string_view meaning) {
  add(name, unit, meaning, ConfigKey::Integer{&member, least, most});
}

void ConfigKeys::boolean(std::string_view name, bool& member, std::string_view meaning) {
  add(name, "", meaning, ConfigKey::Boolean{&member});
}

void ConfigKeys::choice_of(std::string_view name, KeyChoice choice, std::string_view meaning) {
  add(name, "", meaning, std::move(choice));
}

ConfigKeys odometry_keys(OdometryConfig& config) {
  ConfigKeys keys;
  visit_keys(config, keys);
  return keys;
}

const ConfigKey* ConfigKeys::find(std::string_view name) const {
  for (const ConfigSection& section : sections_) {
    for (const ConfigKey& key : section.keys) {
      if (key.name() == name) return &key;
    }
  }
  return nullptr;
}

bool ConfigKeys::has_section(std::string_view name) const {
  return std::any_of(sections_.begin(), sections_.end(),
                     [&](const ConfigSection& section) { return !section.name.empty() && section.name == name; });
}

std::string ConfigKeys::nearest(std::string_view name) const {
  constexpr std::size_t kMost = 3;  // names that are equally near
  const std::string_view section_meant = name.substr(0, std::min(name.find('.'), name.size()));
  const bool within = name.find('.') != std::string_view::npos && has_section(section_meant);
  std::vector<std::string> best;
  std::size_t least = static_cast<std::size_t>(-1);
  const auto consider = [&](const std::string& known) {
    const std::size_t distance = known.empty() ? least : unlikeness(name, known);
    if (distance < least) best.clear();
    if (!known.empty() && distance <= least) best.push_back(known);
    least = std::min(least, distance);
  };
  for (const ConfigSection& section : sections_) {
    if (within && section.name != section_meant) continue;
    if (!within) consider(section.name);
    for (const ConfigKey& key : section.keys) consider(key.name());
  }
  best.resize(std::min(best.size(), kMost));
  std::string text;
  for (const std::string& known : best) text += (text.empty() ? "" : " or ") + known;
  return text;
}

}  // namespace rilo
