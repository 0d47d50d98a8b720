// Tables for a terminal, for Markdown and as comma separated values.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rilo {

/// Rows of text; short rows are filled up. The first `left` columns are flush left, the others flush right.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::size_t left = 1;

  /// Columns padded with blanks, one line per row.
  std::string plain() const;
  /// A Markdown table; bars in cells are escaped.
  std::string markdown() const;
  /// RFC 4180.
  std::string csv() const;
};

}  // namespace rilo
