#include "io/text.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>

namespace rilo::detail {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

// std::from_chars knows no plus sign.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  return text;
}

}  // namespace

std::optional<std::string_view> LineScanner::next() {
  if (offset_ >= text_.size()) return std::nullopt;
  const std::size_t end = text_.find('\n', offset_);
  std::string_view line = text_.substr(offset_, end == std::string_view::npos ? end : end - offset_);
  offset_ = end == std::string_view::npos ? text_.size() : end + 1;
  ++number_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::optional<std::string_view> WordScanner::next() {
  const std::size_t begin = line_.find_first_not_of(kBlanks, offset_);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t end = std::min(line_.find_first_of(kBlanks, begin), line_.size());
  offset_ = end;
  column_ = begin + 1;
  return line_.substr(begin, end - begin);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  WordScanner scanner(line);
  while (const auto word = scanner.next()) words.push_back(*word);
  return words;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return lower;
}

std::optional<double> parse_double(std::string_view text) {
  text = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Too small is as good as zero, too large is not a number.
    value = std::strtod(std::string(text).c_str(), nullptr);
    if (std::abs(value) > 1) return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse_number<std::int64_t>(without_plus(text));
}
std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
  return parse_number<std::uint64_t>(without_plus(text));
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char letter : text.substr(0, kLongest)) result += letter >= ' ' && letter <= '~' ? letter : '?';
  return result + (text.size() > kLongest ? "…'" : "'");
}

std::string at_line(std::size_t line) { return "line " + std::to_string(line); }
std::string at_line(std::size_t line, std::size_t column) {
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace rilo::detail
