#include <algorithm>
#include <map>
#include <stdexcept>

#include <yaml-cpp/yaml.h>

#include "config/yaml_document.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/config/config_key.hpp"

namespace rilo {
namespace {

using detail::kind_of;
using detail::position_of;
using detail::quoted;

constexpr const char* kConfigHint = "`rilo config --dump` shows how the file looks";

// Where a value is, for messages.
struct Place {
  std::string file;
  std::string position;
};

[[noreturn]] void refuse_key(const ConfigKeys& keys, const std::string& name, const Place& place) {
  throw ConfigError({place.file, place.position, "unknown key " + quoted(name), "",
                     "Did you mean " + keys.nearest(name) + "? `rilo config --dump` lists all keys"});
}

void set_key(const ConfigKey& key, const std::string& text, const Place& place) {
  if (key.set(text)) return;
  throw ConfigError({place.file, place.position, key.name() + " is " + quoted(text), key.expected(), ""});
}

using Positions = std::map<std::string, std::string>;  // of the keys of a file, by name

// Values that are each in range and do not go together. They come from the file, or, where it has none of them, from
// `elsewhere`.
void check_together(const OdometryConfig& config, const std::string& file, const Positions& positions,
                    const std::string& elsewhere) {
  try {
    validate(config);
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    const auto named = std::find_if(positions.begin(), positions.end(), [&what](const auto& key) {
      return what.find(key.first + " ") != std::string::npos || what.find(key.first + ",") != std::string::npos;
    });
    if (named == positions.end()) throw ConfigError({elsewhere, "", what, "", ""});
    throw ConfigError({file, named->second, what, "", ""});
  }
}

class Loader {
 public:
  Loader(const ConfigKeys& keys, std::string file) : keys_(keys), file_(std::move(file)) {}

  void load(const YAML::Node& root) {
    if (root.IsNull()) return;
    if (!root.IsMap()) refuse(root, kind_of(root), "a map of keys");
    if (root["elevation_offset_deg"]) {
      throw ConfigError({file_, "", "the calibration of a sensor", "a configuration", "It goes with --calibration"});
    }
    load_map(root, "");
  }

  const Positions& positions() const { return seen_; }

 private:
  void load_map(const YAML::Node& map, const std::string& prefix) {
    for (const auto& pair : map) {
      if (!pair.first.IsScalar()) refuse(pair.first, kind_of(pair.first), "the name of a key");
      load_entry(prefix + pair.first.Scalar(), pair.first, pair.second);
    }
  }

  void load_entry(const std::string& name, const YAML::Node& key_node, const YAML::Node& value) {
    const Place place{file_, position_of(key_node.Mark())};
    const ConfigKey* key = keys_.find(name);
    if (key == nullptr && !keys_.has_section(name) && name != kExpertSection) refuse_key(keys_, name, place);
    // A section may come twice, among the user's keys and the expert ones; a key has one name.
    if (!seen_.emplace(key != nullptr ? key->name() : name, place.position).second) {
      throw ConfigError({file_, place.position, name + " is given a second time", "each key once", "Keep one of them"});
    }
    if (key == nullptr) {
      if (!value.IsMap()) refuse(value.IsNull() ? key_node : value, name + " is " + kind_of(value), "a map of keys");
      load_map(value, name + ".");
      return;
    }
    if (!value.IsScalar()) refuse(value.IsNull() ? key_node : value, name + " is " + kind_of(value), key->expected());
    const bool text_wanted = std::holds_alternative<ConfigKey::Choice>(key->binding());
    if (value.Tag() == "!" && !text_wanted) refuse(value, name + " is text in quotes", key->expected());
    set_key(*key, value.Scalar(), {file_, position_of(value.Mark())});
  }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& found, const std::string& expected) const {
    throw ConfigError({file_, position_of(node.Mark()), found, expected, ""});
  }

  const ConfigKeys& keys_;
  std::string file_;
  Positions seen_;
};

std::string text_of(const std::filesystem::path& file) {
  return detail::read_yaml_file(file, "a configuration file (YAML)", "`rilo config --dump > FILE` makes one");
}

// Returns where the keys are.
Positions load_into(OdometryConfig& config, std::string_view yaml, const std::string& name) {
  const ConfigKeys keys = odometry_keys(config);
  Loader loader(keys, name);
  loader.load(detail::parse_yaml(yaml, name, kConfigHint));
  return loader.positions();
}

void override_values(OdometryConfig& config, const std::vector<std::string>& overrides, const std::string& origin) {
  const ConfigKeys keys = odometry_keys(config);
  for (const std::string& text : overrides) {
    const Place place{origin + " " + text.substr(0, detail::kLongestQuote), ""};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw ConfigError({place.file, "", "there is no \"=\"", "key=value", "Example: icp.max_iterations=20"});
    }
    const std::string name = text.substr(0, equals);
    const ConfigKey* key = keys.find(name);
    if (key == nullptr && keys.has_section(name)) {
      throw ConfigError({place.file, "", quoted(name) + " is a section", "one of its keys, " + quoted(name + ".KEY"),
                         "`rilo config --dump` lists all keys"});
    }
    if (key == nullptr) refuse_key(keys, name, place);
    set_key(*key, text.substr(equals + 1), place);
  }
}

}  // namespace

OdometryConfig parse_config(std::string_view yaml, const std::string& name, const OdometryConfig& base) {
  OdometryConfig config = base;
  check_together(config, name, load_into(config, yaml, name), name);
  return config;
}

OdometryConfig load_config(const std::filesystem::path& file, const OdometryConfig& base) {
  return parse_config(text_of(file), file.string(), base);
}

OdometryConfig load_config(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                           const std::string& origin) {
  if (file.empty()) return with_overrides({}, overrides, origin);
  OdometryConfig config;
  const Positions positions = load_into(config, text_of(file), file.string());
  override_values(config, overrides, origin);
  check_together(config, file.string(), positions, origin);
  return config;
}

OdometryConfig with_overrides(const OdometryConfig& base, const std::vector<std::string>& overrides,
                              const std::string& origin) {
  OdometryConfig config = base;
  override_values(config, overrides, origin);
  if (!overrides.empty()) check_together(config, origin, {}, origin);
  return config;
}

}  // namespace rilo
