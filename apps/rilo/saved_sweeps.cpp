#include "saved_sweeps.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "rilo/io/io_error.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kExpectedSweeps = "sweeps.csv of rilo run";

std::vector<std::string> split_cells(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::size_t from = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', from)) {
    cells.push_back(line.substr(from, comma - from));
    from = comma + 1;
  }
  cells.push_back(line.substr(from));
  return cells;
}

/// Cells of one line by the names of the columns.
class Line {
 public:
  Line(const std::filesystem::path& file, std::size_t number, const std::vector<std::string>& header,
       std::vector<std::string> cells)
      : file_(file), number_(number), header_(header), cells_(std::move(cells)) {
    if (cells_.size() != header_.size()) {
      throw IoError({file_, fmt::format("line {}", number_), fmt::format("{} values", cells_.size()),
                     fmt::format("{}, as the header has names", header_.size()), "Run rilo run again"});
    }
  }

  template <typename Number>
  Number number(std::string_view column) const {
    const std::string& text = cell(column);
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) fail(column, "a number");
    return value;
  }

  /// The value that to_string gives this word for.
  template <typename Enum>
  Enum word(std::string_view column, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (to_string(static_cast<Enum>(i)) == cell(column)) return static_cast<Enum>(i);
    }
    fail(column, "one of the words of docs/command.md");
  }

 private:
  const std::string& cell(std::string_view column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    if (found == header_.end()) {
      throw IoError({file_, "line 1", fmt::format("no column {}", column), kExpectedSweeps, "Run rilo run again"});
    }
    return cells_[static_cast<std::size_t>(found - header_.begin())];
  }

  [[noreturn]] void fail(std::string_view column, const char* expected) const {
    throw IoError({file_, fmt::format("line {}, column {}", number_, column), fmt::format("\"{}\"", cell(column)),
                   expected, "Run rilo run again"});
  }

  const std::filesystem::path& file_;
  std::size_t number_;
  const std::vector<std::string>& header_;
  std::vector<std::string> cells_;
};

SweepResult result_of(const Line& line) {
  constexpr std::size_t kInitialPoses = 3;
  SweepResult result;
  SweepStats& s = result.stats;
  result.stamp_ns = line.number<std::int64_t>("stamp_ns");
  result.status = line.word<OdometryStatus>("status", kStatusCount);
  s.initial_pose = line.word<InitialPoseSource>("initial_pose", kInitialPoses);
  s.iterations = line.number<int>("iterations");
  s.inlier_ratio = line.number<double>("inlier_ratio");
  s.sigma_th_m = line.number<double>("sigma_th_m");
  s.times.preprocess_ms = line.number<double>("preprocess_ms");
  s.times.initial_pose_ms = line.number<double>("initial_pose_ms");
  s.times.registration_ms = line.number<double>("registration_ms");
  s.times.map_ms = line.number<double>("map_ms");
  s.times.total_ms = line.number<double>("total_ms");
  return result;
}

}  // namespace

SavedSweeps read_sweeps_csv(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  if (!std::filesystem::is_regular_file(file, ignored) || !stream || !std::getline(stream, text)) {
    throw IoError(
        {file, "", "no file that can be read", kExpectedSweeps, "Give the folder that --out of rilo run named"});
  }
  const std::vector<std::string> header = split_cells(text);
  SavedSweeps sweeps;
  for (std::size_t number = 2; std::getline(stream, text); ++number) {
    if (text.empty()) continue;
    const Line line(file, number, header, split_cells(text));
    sweeps.indices.push_back(line.number<std::size_t>("sweep"));
    sweeps.results.push_back(result_of(line));
  }
  return sweeps;
}

}  // namespace rilo::cli
