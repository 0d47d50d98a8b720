// Text for people and for files.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "io/folder_files.hpp"
#include "io/text.hpp"

namespace rilo {

/// Indented; bytes of file names that are not UTF-8 are replaced.
std::string json_text(const nlohmann::json& json);

/// `text` with such bytes replaced.
std::string valid_utf8(const std::string& text);

/// For a line on a terminal: control characters, of file names and of data, as \n or \x1b.
std::string printable(const std::string& text);

/// null for a figure that is not there.
nlohmann::json or_null(const std::optional<double>& value);

/// Within single quotes, for sh, bash and zsh.
std::string shell_quoted(const std::string& word);

/// The command line as one would type it.
std::string command_line(int argc, const char* const* argv);

using detail::counted;
using detail::last_name;

}  // namespace rilo
