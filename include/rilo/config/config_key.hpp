// One key of a configuration file: name, type, range, unit, meaning, and the member it stands for.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace rilo {

/// What stands after the last dot of a key's name.
inline std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

/// A key bound to a member of a configuration struct, which must outlive it.
class ConfigKey {
 public:
  struct Real {
    double* member;
    double least, most;
  };
  struct Integer {
    int* member;
    int least, most;
  };
  struct Boolean {
    bool* member;
  };
  /// A member of an enum type: the words in order, and access by their place.
  struct Choice {
    std::vector<std::string> words;
    std::function<std::size_t()> get;
    std::function<void(std::size_t)> set;
  };
  using Binding = std::variant<Real, Integer, Boolean, Choice>;

  ConfigKey(std::string name, std::string unit, std::string meaning, Binding binding)
      : name_(std::move(name)), unit_(std::move(unit)), meaning_(std::move(meaning)), binding_(std::move(binding)) {}

  const std::string& name() const { return name_; }                ///< dotted: "icp.max_iterations"
  std::string_view last_name() const { return last_part(name_); }  ///< "max_iterations"
  const std::string& unit() const { return unit_; }                ///< empty: none
  const std::string& meaning() const { return meaning_; }
  const Binding& binding() const { return binding_; }

  /// The value as it stands in a file; no digit of a number is lost.
  std::string value() const;

  /// What may be set, for people: "0 … 100", "true or false", "fixed_tau or map_score".
  std::string allowed() const;

  /// The same with the type and the unit: "a number from 0 to 100 m".
  std::string expected() const;

  /// Sets the member from text. False, and nothing is changed, when the text is not what is allowed; NaN never is.
  bool set(std::string_view text) const;

 private:
  std::string name_;
  std::string unit_;
  std::string meaning_;
  Binding binding_;
};

/// A part of the configuration: the keys "NAME.…"; the first section has no name.
struct ConfigSection {
  std::string name;
  std::string meaning;
  std::vector<ConfigKey> keys;
};

/// All keys in the order of the file.
class ConfigKeys {
 public:
  ConfigKeys() : sections_(1) {}

  /// The keys that follow are "NAME.…".
  void section(std::string name, std::string meaning) {
    sections_.push_back({std::move(name), std::move(meaning), {}});
  }

  void real(std::string_view name, double& member, double least, double most, std::string unit, std::string meaning);
  void integer(std::string_view name, int& member, int least, int most, std::string unit, std::string meaning);
  void boolean(std::string_view name, bool& member, std::string meaning);

  template <typename Enum>
  struct Word {
    std::string text;
    Enum value;
  };
  template <typename Enum>
  void choice(std::string_view name, Enum& member, std::vector<Word<Enum>> words, std::string meaning);

  const std::vector<ConfigSection>& sections() const { return sections_; }

  /// The key of that dotted name, or null.
  const ConfigKey* find(std::string_view name) const;
  bool has_section(std::string_view name) const;

  /// The known name (of a key or a section) that looks most like `name`.
  std::string nearest(std::string_view name) const;

 private:
  void add(std::string_view name, std::string unit, std::string meaning, ConfigKey::Binding binding);

  std::vector<ConfigSection> sections_;
};

template <typename Enum>
void ConfigKeys::choice(std::string_view name, Enum& member, std::vector<Word<Enum>> words, std::string meaning) {
  ConfigKey::Choice choice;
  std::vector<Enum> values;
  for (const Word<Enum>& word : words) {
    choice.words.push_back(word.text);
    values.push_back(word.value);
  }
  choice.get = [&member, values] {
    std::size_t place = 0;
    while (place + 1 < values.size() && values[place] != member) ++place;
    return place;
  };
  choice.set = [&member, values](std::size_t place) { member = values.at(place); };
  add(name, "", std::move(meaning), std::move(choice));
}

}  // namespace rilo
