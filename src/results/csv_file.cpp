#include "results/csv_file.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/file_bytes.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

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

}  // namespace

CsvFile::CsvFile(std::filesystem::path file, const CsvKind& kind)
    : file_(std::move(file)), kind_(kind), stream_(file_, std::ios::binary) {
  std::string text;
  if (!detail::is_file(file_) || !stream_ || !std::getline(stream_, text)) {
    throw IoError({file_, "", "no file that can be read", kind_.expected, kind_.missing_remedy});
  }
  header_ = split_cells(text);
}

bool CsvFile::next() {
  std::string text;
  while (std::getline(stream_, text)) {
    ++number_;
    if (text.empty() || text == "\r") continue;
    cells_ = split_cells(text);
    if (cells_.size() == header_.size()) return true;
    throw IoError({file_, fmt::format("line {}", number_), fmt::format("{} values", cells_.size()),
                   fmt::format("{}, as the header has names", header_.size()), kind_.remedy});
  }
  return false;
}

bool CsvFile::has(std::string_view column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

void CsvFile::need(std::string_view column) const {
  if (has(column)) return;
  throw IoError({file_, "line 1", fmt::format("no column {}", column), kind_.expected, kind_.remedy});
}

const std::string& CsvFile::cell(std::string_view column) const {
  need(column);
  return cells_[static_cast<std::size_t>(std::find(header_.begin(), header_.end(), column) - header_.begin())];
}

void CsvFile::refuse(std::string_view column, const std::string& expected) const {
  throw IoError({file_, fmt::format("line {}, column {}", number_, column), fmt::format("\"{}\"", cell(column)),
                 expected, kind_.remedy});
}

}  // namespace rilo
