// Text files: lines, words and numbers, with their places for messages.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rilo::detail {

/// Walks through the lines of a text without copying; a carriage return before the line feed is taken off, and a mark
/// of UTF-8 (BOM), as Windows' editors write it, from the first one.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : text_(text), offset_(text.starts_with("\xEF\xBB\xBF") ? 3 : 0) {}

  /// The next line, or nothing at the end. A text that ends with a line feed has no empty last line.
  std::optional<std::string_view> next();

  std::size_t number() const { return number_; }  ///< of the last line, from 1
  std::size_t offset() const { return offset_; }  ///< of the byte after it

 private:
  std::string_view text_;
  std::size_t offset_;
  std::size_t number_ = 0;
};

/// Walks through the words of a line, separated by blanks or tabs.
class WordScanner {
 public:
  explicit WordScanner(std::string_view line) : line_(line) {}
  std::optional<std::string_view> next();
  std::size_t column() const { return column_; }  ///< of the last word, from 1

 private:
  std::string_view line_;
  std::size_t offset_ = 0;
  std::size_t column_ = 0;
};

std::vector<std::string_view> words_of(std::string_view line);
std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

/// The whole text as a number, as C++ prints one, or nothing.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// The same with a plus sign before it ("nan" and "inf" included); too small a number is zero.
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// "1 sweep", "2 sweeps".
std::string counted(std::size_t count, const std::string& thing);

/// For messages: in quotes, cut after 40 characters, bytes that are not printable ASCII as '?'.
std::string in_quotes(std::string_view text);

/// "line 3" and "line 3, column 7".
std::string at_line(std::size_t line);
std::string at_line(std::size_t line, std::size_t column);

}  // namespace rilo::detail
