#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "config/nearest_word.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

// A key in the wrong section is still meant: its last part counts too, at a small price.
std::size_t unlikeness(std::string_view wanted, std::string_view known) {
  return std::min(edit_distance(wanted, known), edit_distance(last_part(wanted), last_part(known)) + 1);
}

}  // namespace

std::string_view without_expert(std::string_view name) {
  const std::size_t length = kExpertSection.size();
  const bool expert = name.starts_with(kExpertSection) && name.size() > length && name[length] == '.';
  return expert ? name.substr(length + 1) : name;
}

void ConfigKeys::add(const KeyInfo& key, ConfigKey::Binding binding) {
  ConfigSection& section = sections_.back();
  std::string full = section.name.empty() ? std::string(key.name) : section.name + "." + std::string(key.name);
  section.keys.emplace_back(std::move(full), key, std::move(binding));
}

void ConfigKeys::real(const KeyInfo& key, double& member, double least, double most) {
  add(key, ConfigKey::Real{&member, least, most});
}

void ConfigKeys::integer(const KeyInfo& key, int& member, int least, int most) {
  add(key, ConfigKey::Integer{&member, least, most});
}

void ConfigKeys::boolean(const KeyInfo& key, bool& member) { add(key, ConfigKey::Boolean{&member}); }

void ConfigKeys::choice_of(const KeyInfo& key, KeyChoice choice) { add(key, std::move(choice)); }

ConfigKeys odometry_keys(OdometryConfig& config) {
  ConfigKeys keys;
  visit_keys(config, keys);
  return keys;
}

const ConfigKey* ConfigKeys::find(std::string_view name) const {
  name = without_expert(name);
  for (const ConfigSection& section : sections_) {
    for (const ConfigKey& key : section.keys) {
      if (key.name() == name) return &key;
    }
  }
  return nullptr;
}

bool ConfigKeys::has_section(std::string_view name) const {
  name = without_expert(name);
  return std::any_of(sections_.begin(), sections_.end(),
                     [&](const ConfigSection& section) { return !section.name.empty() && section.name == name; });
}

std::string ConfigKeys::nearest(std::string_view name) const {
  name = without_expert(name);
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
  return fmt::format("{}", fmt::join(best, " or "));
}

}  // namespace rilo
