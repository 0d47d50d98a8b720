#include "results/json_file.hpp"

#include <fstream>

#include <fmt/format.h>

#include "rilo/io/io_error.hpp"

namespace rilo {

nlohmann::json read_json_object(const std::filesystem::path& file, const std::string& expected,
                                const std::string& remedy) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, ignored) || !stream) {
    throw IoError({file, "", "no file that can be read", expected, remedy});
  }
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(stream);
  } catch (const nlohmann::json::parse_error& error) {
    throw IoError({file, fmt::format("byte {}", error.byte), "this is not JSON", expected, ""});
  }
  if (!json.is_object())
    throw IoError({file, "", std::string("JSON of another kind, ") + json.type_name(), expected, ""});
  return json;
}

}  // namespace rilo
