// YAML files with errors that say where; shared by all that is configured so.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <yaml-cpp/yaml.h>

namespace rilo::detail {

constexpr std::size_t kLongestQuote = 60;

/// "line 3, column 5"; empty when unknown.
std::string position_of(const YAML::Mark& mark);

/// In quotation marks, cut when it is long.
std::string quoted(const std::string& text);

/// What a node is, for messages: "a list", "no value", the quoted text.
std::string kind_of(const YAML::Node& node);

/// The bytes of a file of at most 1 MiB. @throws ConfigError; `expected` and `remedy` say what such a file is and where
/// it comes from.
std::string read_yaml_file(const std::filesystem::path& file, const std::string& expected, const std::string& remedy);

/// The root of the one document in `yaml`. @throws ConfigError with line and column; `name` stands for the file, `hint`
/// says where to find how it should look.
YAML::Node parse_yaml(std::string_view yaml, const std::string& name, const std::string& hint);

}  // namespace rilo::detail
