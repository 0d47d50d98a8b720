#include <algorithm>
#include <numeric>

#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

// Levenshtein's distance: insertions, deletions and replacements.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

// A key in the wrong section is still meant: its last part counts too, at a small price.
std::size_t unlikeness(std::string_view wanted, std::string_view known) {
  return std::min(edit_distance(wanted, known), edit_distance(last_part(wanted), last_part(known)) + 1);
}

}  // namespace

void ConfigKeys::add(std::string_view name, std::string unit, std::string meaning, ConfigKey::Binding binding) {
  ConfigSection& section = sections_.back();
  std::string full = section.name.empty() ? std::string(name) : section.name + "." + std::string(name);
  section.keys.emplace_back(std::move(full), std::move(unit), std::move(meaning), std::move(binding));
}

void ConfigKeys::real(std::string_view name, double& member, double least, double most, std::string unit,
                      std::string meaning) {
  add(name, std::move(unit), std::move(meaning), ConfigKey::Real{&member, least, most});
}

void ConfigKeys::integer(std::string_view name, int& member, int least, int most, std::string unit,
                         std::string meaning) {
  add(name, std::move(unit), std::move(meaning), ConfigKey::Integer{&member, least, most});
}

void ConfigKeys::boolean(std::string_view name, bool& member, std::string meaning) {
  add(name, "", std::move(meaning), ConfigKey::Boolean{&member});
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
  // Longer texts are not compared: the table of the distance is quadratic.
  name = name.substr(0, 100);
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  const auto consider = [&](const std::string& known) {
    const std::size_t distance = known.empty() ? least : unlikeness(name, known);
    if (distance < least) {
      least = distance;
      best = known;
    }
  };
  for (const ConfigSection& section : sections_) {
    consider(section.name);
    for (const ConfigKey& key : section.keys) consider(key.name());
  }
  return best;
}

}  // namespace rilo
