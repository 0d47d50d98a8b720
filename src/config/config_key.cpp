#include "rilo/config/config_key.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "io/text.hpp"

namespace rilo {
namespace {

// Shortest text that reads back as the same number, and that looks like a real one.
std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string list_of(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " or ")); }

// One overload a type of key; see ConfigKey's functions of the same names.
struct Value {
  std::string operator()(const ConfigKey::Real& key) const { return real_text(*key.member); }
  std::string operator()(const ConfigKey::Integer& key) const { return std::to_string(*key.member); }
  std::string operator()(const ConfigKey::Boolean& key) const { return *key.member ? "true" : "false"; }
  std::string operator()(const ConfigKey::Choice& key) const { return key.words.at(key.get()); }
};

struct Allowed {
  std::string operator()(const ConfigKey::Real& key) const { return fmt::format("{} … {}", key.least, key.most); }
  std::string operator()(const ConfigKey::Integer& key) const { return fmt::format("{} … {}", key.least, key.most); }
  std::string operator()(const ConfigKey::Boolean&) const { return "true or false"; }
  std::string operator()(const ConfigKey::Choice& key) const { return list_of(key.words); }
};

struct Expected {
  std::string operator()(const ConfigKey::Real& key) const {
    return fmt::format("a number from {} to {}", key.least, key.most);
  }
  std::string operator()(const ConfigKey::Integer& key) const {
    return fmt::format("a whole number from {} to {}", key.least, key.most);
  }
  std::string operator()(const ConfigKey::Boolean&) const { return "true or false"; }
  std::string operator()(const ConfigKey::Choice& key) const { return list_of(key.words); }
};

struct Set {
  std::string_view text;

  // Comparisons with NaN are false.
  bool operator()(const ConfigKey::Real& key) const {
    const auto value = detail::parse_number<double>(text);
    if (!value || !(*value >= key.least && *value <= key.most)) return false;
    *key.member = *value;
    return true;
  }
  bool operator()(const ConfigKey::Integer& key) const {
    const auto value = detail::parse_number<int>(text);
    if (!value || *value < key.least || *value > key.most) return false;
    *key.member = *value;
    return true;
  }
  bool operator()(const ConfigKey::Boolean& key) const {
    if (text != "true" && text != "false") return false;
    *key.member = text == "true";
    return true;
  }
  bool operator()(const ConfigKey::Choice& key) const {
    const auto word = std::find(key.words.begin(), key.words.end(), text);
    if (word == key.words.end()) return false;
    key.set(static_cast<std::size_t>(word - key.words.begin()));
    return true;
  }
};

}  // namespace

std::string ConfigKey::value() const { return std::visit(Value{}, binding_); }

std::string ConfigKey::allowed() const { return std::visit(Allowed{}, binding_); }

std::string ConfigKey::expected() const {
  return std::visit(Expected{}, binding_) + (unit_.empty() ? "" : " " + unit_);
}

bool ConfigKey::set(std::string_view text) const { return std::visit(Set{text}, binding_); }

}  // namespace rilo
