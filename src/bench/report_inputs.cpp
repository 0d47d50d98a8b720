#include "bench/report_inputs.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "bench/saved_results.hpp"
#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "results/saved_run.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExpectedResults =
    "a folder of rilo run (metrics.json, or poses_lidar.partial.txt), a folder, results.json or results.sqlite of rilo "
    "bench, or a pose file as NAME=FILE";

struct NamedPath {
  std::string name;  // empty: none was given
  std::string path;
};

NamedPath named_path(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (detail::path_exists(word) || equals == std::string::npos) return {"", word};
  if (equals == 0 || equals + 1 == word.size()) {
    throw RunError(RunErrorKind::kUsage,
                   "\"" + word + "\": expected a name before and a path after the =. See: rilo report --help");
  }
  return {word.substr(0, equals), word.substr(equals + 1)};
}

/// The first few names in a folder, for a message.
std::string contents(const fs::path& folder) {
  constexpr std::size_t kShown = 6;
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  if (names.empty()) return "an empty folder";
  const std::size_t more = names.size() - std::min(kShown, names.size());
  names.resize(names.size() - more);
  return fmt::format("a folder with {}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

std::optional<ReportInputKind> kind_of(const fs::path& path) {
  if (is_saved_results(path)) return ReportInputKind::kBench;
  if (detail::is_file(path)) return ReportInputKind::kPoses;
  if (is_saved_run(path)) return ReportInputKind::kRun;
  return std::nullopt;
}

}  // namespace

ReportInput parse_report_input(const std::string& word) {
  const NamedPath named = named_path(word);
  ReportInput input;
  input.path = named.path;
  const std::size_t slash = named.name.rfind('/');
  input.sequence = slash == std::string::npos ? "" : valid_utf8(named.name.substr(0, slash));
  input.name = valid_utf8(slash == std::string::npos ? named.name : named.name.substr(slash + 1));
  input.named = !input.name.empty();
  if (!detail::path_exists(named.path)) throw IoError({input.path, "", "nothing", kExpectedResults, "Check the path"});
  const auto kind = kind_of(input.path);
  if (!kind) {
    const bool data = detail::path_exists(input.path / "velodyne");
    throw IoError({input.path, "", contents(input.path), kExpectedResults,
                   data ? "These are data: give them to rilo run --out first" : "Give the folder after --out"});
  }
  input.kind = *kind;
  if (input.kind == ReportInputKind::kBench && !input.sequence.empty()) {
    throw RunError(RunErrorKind::kUsage,
                   "\"" + word + "\": results of rilo bench name their sequences themselves; leave SEQUENCE/ out");
  }
  if (input.kind == ReportInputKind::kPoses && input.name.empty()) input.name = valid_utf8(input.path.stem().string());
  return input;
}

ReportTruth parse_report_truth(const std::string& word) {
  const NamedPath named = named_path(word);
  if (!detail::path_exists(named.path)) {
    throw IoError({named.path, "", "nothing", "true poses: a file, or a data folder", "Check the path after --gt"});
  }
  return {valid_utf8(named.name), named.path};
}

}  // namespace rilo
