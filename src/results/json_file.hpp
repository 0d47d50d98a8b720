// JSON files of our own, read back.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace rilo {

/// The object in `file`. `expected` and `remedy` are parts of the message.
/// @throws IoError when it cannot be read, is not JSON or not an object.
nlohmann::json read_json_object(const std::filesystem::path& file, const std::string& expected,
                                const std::string& remedy);

}  // namespace rilo
