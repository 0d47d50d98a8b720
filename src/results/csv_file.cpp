#include "results/csv_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

std::vector<std::string> split_cells(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    cells.emplace_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  cells.emplace_back(line);
  return cells;
}

// Empty for what is no file; one that may not be read is refused.
detail::FileBytes bytes_of(const std::filesystem::path& file) {
  return detail::is_file(file) ? detail::read_file(file) : detail::FileBytes{file, nullptr, 0};
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& file, const CsvKind& kind)
    : kind_(kind), bytes_(bytes_of(file)), lines_(bytes_.view()) {
  const auto header = lines_.next();
  if (!header) throw IoError({bytes_.path, "", "no file that can be read", kind_.expected, kind_.missing_remedy});
  header_ = split_cells(*header);
}

bool CsvFile::next() {
  while (const auto line = lines_.next()) {
    if (line->empty()) continue;
    cells_ = split_cells(*line);
    if (cells_.size() == header_.size()) return true;
    throw IoError({bytes_.path, detail::at_line(lines_.number()), detail::counted(cells_.size(), "value"),
                   fmt::format("{}, as the header has names", header_.size()), kind_.remedy});
  }
  return false;
}

bool CsvFile::has(std::string_view column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

void CsvFile::need(std::string_view column) const {
  if (has(column)) return;
  throw IoError({bytes_.path, "line 1", fmt::format("no column {}", column), kind_.expected, kind_.remedy});
}

const std::string& CsvFile::cell(std::string_view column) const {
  need(column);
  return cells_[static_cast<std::size_t>(std::find(header_.begin(), header_.end(), column) - header_.begin())];
}

void CsvFile::refuse(std::string_view column, const std::string& expected) const {
  throw IoError({bytes_.path, fmt::format("line {}, column {}", lines_.number(), column),
                 fmt::format("\"{}\"", cell(column)), expected, kind_.remedy});
}

}  // namespace rilo
