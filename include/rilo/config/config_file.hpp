// The odometry's configuration to and from YAML.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/io/io_error.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// An IoError of its own kind, since a wrong configuration is the user's to put right, not the data's.
class ConfigError : public IoError {
 public:
  explicit ConfigError(IoProblem problem) : IoError(std::move(problem)) {}
};

/// The configuration `base`, overridden by `file`, which may hold any part of the keys.
/// @throws ConfigError with line and column: no YAML, unknown or repeated key (the nearest known one is named), wrong
/// type, out of range, values that contradict each other.
OdometryConfig load_config(const std::filesystem::path& file, const OdometryConfig& base = {});

/// The same from text; `name` is the file's name in messages.
OdometryConfig parse_config(std::string_view yaml, const std::string& name, const OdometryConfig& base = {});

/// The same with overrides as with_overrides takes them; `file` empty: the overrides alone. Values that contradict each
/// other are found at the end.
OdometryConfig load_config(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                           const std::string& origin = "--set");

/// Applies "key=value" in turn, e.g. "icp.max_iterations=20"; values that contradict each other are found at the end.
/// `origin` names in messages where they come from.
/// @throws ConfigError
OdometryConfig with_overrides(const OdometryConfig& base, const std::vector<std::string>& overrides,
                              const std::string& origin = "--set");

/// YAML with all keys, their units, ranges and meanings, in the order of odometry_keys. Loading it gives exactly
/// `config`.
std::string dump_config(const OdometryConfig& config);

/// Table of the keys for users, with the values of `config` as defaults, for the documentation.
std::string config_markdown(const OdometryConfig& config);

}  // namespace rilo
