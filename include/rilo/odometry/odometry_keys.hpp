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

/// A member of an enum type: the words in order, and access by their place; that of none is behind the last.
struct KeyChoice {
  std::vector<std::string> words;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};

/// What is done with each key, in the order of the configuration file.
class KeyVisitor {
 public:
  virtual ~KeyVisitor() = default;

  /// The keys that follow are "NAME.…".
  virtual void section(std::string_view name, std::string_view meaning) = 0;
  virtual void real(std::string_view name, double& member, double least, double most, std::string_view unit,
                    std::string_view meaning) = 0;
  virtual void integer(std::string_view name, int& member, int least, int most, std::string_view unit,
                       std::string_view meaning) = 0;
  virtual void boolean(std::string_view name, bool& member, std::string_view meaning) = 0;
  virtual void choice_of(std::string_view name, KeyChoice choice, std::string_view meaning) = 0;

  template <typename Enum>
  struct Word {
    std::string text;
    Enum value;
  };
  template <typename Enum>
  void choice(std::string_view name, Enum& member, std::vector<Word<Enum>> words, std::string_view meaning);
};

/// Shows every key of `config`, with the member it stands for.
void visit_keys(OdometryConfig& config, KeyVisitor& keys);

template <typename Enum>
void KeyVisitor::choice(std::string_view name, Enum& member, std::vector<Word<Enum>> words, std::string_view meaning) {
  KeyChoice choice;
  std::vector<Enum> values;
  for (const Word<Enum>& word : words) {
    choice.words.push_back(word.text);
    values.push_back(word.value);
  }
  choice.get = [&member, values] {
    std::size_t place = 0;
    while (place < values.size() && values[place] != member) ++place;
    return place;
  };
  choice.set = [&member, values](std::size_t place) { member = values.at(place); };
  choice_of(name, std::move(choice), meaning);
}

}  // namespace rilo
