// Comma separated values with a header, read by the names of the columns.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/text.hpp"

namespace rilo {

/// What messages about the file say.
struct CsvKind {
  const char* expected;  ///< "sweeps.csv of rilo run"
  const char* remedy;
  const char* missing_remedy;  ///< where the file is none
};

/// One line at a time. Cells are not quoted.
class CsvFile {
 public:
  /// @throws IoError: no file, or an empty one.
  CsvFile(const std::filesystem::path& file, const CsvKind& kind);

  /// To the next line that is not empty; false at the end. @throws IoError: not as many cells as the header has.
  bool next();

  bool has(std::string_view column) const;
  /// @throws IoError: no such column.
  void need(std::string_view column) const;
  /// Of this line. @throws IoError: no such column.
  const std::string& cell(std::string_view column) const;

  /// @throws IoError: no number.
  template <typename Number>
  Number number(std::string_view column) const {
    const auto value = detail::parse_number<Number>(cell(column));
    if (!value) refuse(column, "a number");
    return *value;
  }

  /// @throws IoError: of the cell in this line.
  [[noreturn]] void refuse(std::string_view column, const std::string& expected) const;

 private:
  CsvKind kind_;
  detail::FileBytes bytes_;
  detail::LineScanner lines_;
  std::vector<std::string> header_;
  std::vector<std::string> cells_;
};

}  // namespace rilo
