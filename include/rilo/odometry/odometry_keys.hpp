// Every key of the configuration: the one table that validation, the configuration file and its documentation read.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// A member of an enum type: its words in order, and access by index; a value without a word is behind the last.
struct KeyChoice {
  std::vector<std::string> words;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};

/// Description of a key.
struct KeyInfo {
  std::string_view name;         ///< after the section: "max_range_m"
  std::string_view unit;         ///< empty: none
  std::string_view meaning;      ///< with the symbol of docs/method.md where it has one
  std::string_view source = {};  ///< of an expert key: the equation or experiment that its value comes from

  /// Whether the key is for experiments with the method; no sensor and no robot has a reason to change it.
  bool expert() const { return !source.empty(); }
};

/// What is done with each key, in the order of the table.
class KeyVisitor {
 public:
  virtual ~KeyVisitor() = default;

  /// The keys that follow are "NAME.…".
  virtual void section(std::string_view name, std::string_view meaning) = 0;
  virtual void real(const KeyInfo& key, double& member, double least, double most) = 0;
  virtual void integer(const KeyInfo& key, int& member, int least, int most) = 0;
  virtual void boolean(const KeyInfo& key, bool& member) = 0;
  virtual void choice_of(const KeyInfo& key, KeyChoice choice) = 0;

  template <typename Enum>
  struct Word {
    std::string text;
    Enum value;
  };
  template <typename Enum>
  void choice(const KeyInfo& key, Enum& member, const std::vector<Word<Enum>>& words);
};

/// Shows every key of `config`, with its member.
void visit_keys(OdometryConfig& config, KeyVisitor& keys);

template <typename Enum>
void KeyVisitor::choice(const KeyInfo& key, Enum& member, const std::vector<Word<Enum>>& words) {
  KeyChoice choice;
  std::vector<Enum> values;
  for (const Word<Enum>& word : words) {
    choice.words.push_back(word.text);
    values.push_back(word.value);
  }
  choice.get = [&member, values] {
    std::size_t index = 0;
    while (index < values.size() && values[index] != member) ++index;
    return index;
  };
  choice.set = [&member, values](std::size_t index) { member = values.at(index); };
  choice_of(key, std::move(choice));
}

}  // namespace rilo
