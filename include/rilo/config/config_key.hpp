// One key of a configuration file: name, type, range, unit, meaning, source, and its member.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "rilo/odometry/odometry_keys.hpp"

namespace rilo {

/// What comes after the last dot of a key's name.
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
  using Choice = KeyChoice;
  using Binding = std::variant<Real, Integer, Boolean, Choice>;

  ConfigKey(std::string name, const KeyInfo& info, Binding binding)
      : name_(std::move(name)),
        unit_(info.unit),
        meaning_(info.meaning),
        source_(info.source),
        binding_(std::move(binding)) {}

  const std::string& name() const { return name_; }                ///< dotted: "icp.max_iterations"
  std::string_view last_name() const { return last_part(name_); }  ///< "max_iterations"
  const std::string& unit() const { return unit_; }                ///< empty: none
  const std::string& meaning() const { return meaning_; }
  const std::string& source() const { return source_; }  ///< KeyInfo::source
  bool expert() const { return !source_.empty(); }
  const Binding& binding() const { return binding_; }

  /// The value as written to a file; no digit of a number is lost.
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
  std::string source_;
  Binding binding_;
};

/// The map of a configuration file below which expert keys are written; "expert.icp.gate" is another name of
/// "icp.gate".
inline constexpr std::string_view kExpertSection = "expert";
/// The name of a key without that section before it, whether it is there or not.
std::string_view without_expert(std::string_view name);

/// A part of the configuration: the keys "NAME.…"; the first section has no name.
struct ConfigSection {
  std::string name;
  std::string meaning;
  std::vector<ConfigKey> keys;
};

/// All keys in the order of the file.
class ConfigKeys : public KeyVisitor {
 public:
  ConfigKeys() : sections_(1) {}

  void section(std::string_view name, std::string_view meaning) override {
    sections_.push_back({std::string(name), std::string(meaning), {}});
  }
  void real(const KeyInfo& key, double& member, double least, double most) override;
  void integer(const KeyInfo& key, int& member, int least, int most) override;
  void boolean(const KeyInfo& key, bool& member) override;
  void choice_of(const KeyInfo& key, KeyChoice choice) override;

  const std::vector<ConfigSection>& sections() const { return sections_; }

  /// The key of that dotted name, with or without "expert." before it, or null.
  const ConfigKey* find(std::string_view name) const;
  bool has_section(std::string_view name) const;

  /// The known name that looks most like `name`: of the keys of its section when that is known, else of all keys and
  /// sections. Several joined by " or " when they are equally near.
  std::string nearest(std::string_view name) const;

 private:
  void add(const KeyInfo& key, ConfigKey::Binding binding);

  std::vector<ConfigSection> sections_;
};

/// Every key of the odometry's `config`, which must outlive them.
ConfigKeys odometry_keys(OdometryConfig& config);

}  // namespace rilo
