#include "bench/saved_results.hpp"

#include <fmt/format.h>

#include "bench/output.hpp"
#include "results/json_file.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

constexpr const char* kResults = "results.json";
constexpr const char* kExpected = "results.json or results.sqlite of rilo bench";

bool is_result_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_store(const fs::path& file) { return file.extension() == fs::path(kStoreName).extension(); }

bool is_cell(const nlohmann::json& cell) {
  const auto has = [&](const char* key, auto is) { return cell.contains(key) && (cell[key].*is)(); };
  return cell.is_object() && has("sequence", &nlohmann::json::is_string) &&
         has("configuration", &nlohmann::json::is_string) && has("figures", &nlohmann::json::is_object);
}

nlohmann::json read_json_results(const fs::path& file) {
  nlohmann::json json = read_json_object(file, kExpected, "Check the path");
  if (json.value("rilo_bench", nlohmann::json()) != 1 || !json.contains("cells") || !json["cells"].is_array()) {
    throw IoError(
        {file, "", "JSON of another kind", std::string(kExpected) + " (\"rilo_bench\": 1 and a list cells)", ""});
  }
  for (std::size_t i = 0; i < json["cells"].size(); ++i) {
    if (is_cell(json["cells"][i])) continue;
    throw IoError(
        {file, fmt::format("cell {}", i + 1), "a cell without sequence, configuration or figures", kExpected, ""});
  }
  return json;
}

}  // namespace

bool is_saved_results(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return is_result_file(path / kResults) || is_result_file(path / kStoreName);
  return is_result_file(path) && (path.extension() == ".json" || is_store(path));
}

nlohmann::json read_saved_results(const fs::path& path) {
  std::error_code ignored;
  fs::path file = path;
  if (fs::is_directory(path, ignored)) file = path / (is_result_file(path / kResults) ? kResults : kStoreName);
  return is_store(file) ? results_json(bench_output(read_store(file)).bench) : read_json_results(file);
}

}  // namespace rilo
