#include "io/folders/stamp_list.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <string>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace detail {
namespace {

bool all_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char letter) { return std::isdigit(letter) != 0; });
}

template <typename Parse>
std::vector<std::int64_t> read_lines(const std::filesystem::path& file, Parse&& parse, const char* expected,
                                     const char* remedy) {
  const FileBytes bytes = read_file(file);
  LineScanner lines(bytes.view());
  std::vector<std::int64_t> stamps;
  while (const auto line = lines.next()) {
    const std::string_view text = trimmed(*line);
    if (text.empty()) continue;
    if (text.front() == '#') continue;
    const std::optional<std::int64_t> stamp = parse(text);
    if (!stamp) throw IoError({file, at_line(lines.number()), in_quotes(text), expected, remedy});
    stamps.push_back(*stamp);
  }
  return stamps;
}

// "2011-09-26 13:02:25.951199337", taken as UTC, in ns since 1970.
std::optional<std::int64_t> parse_date(std::string_view text) {
  int to_seconds = 0;  // characters; "2011-9-26 9:02:" has fewer than "2011-09-26 09:02:"
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  std::int64_t hour = 0;
  std::int64_t minute = 0;
  const std::string line(text);
  const int read = std::sscanf(line.c_str(), "%4d-%2u-%2u %2ld:%2ld:%n", &year, &month, &day, &hour, &minute,  // NOLINT
                               &to_seconds);
  if (read != 5 || to_seconds == 0) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  const auto seconds = parse_stamp(text.substr(static_cast<std::size_t>(to_seconds)));
  if (!date.ok() || hour < 0 || hour > 23 || minute < 0 || minute > 59 || !seconds || *seconds < 0) return std::nullopt;
  if (*seconds > 61'000'000'000 || year < 1970 || year > 2200) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60'000'000'000 + *seconds;
}

}  // namespace

std::optional<std::int64_t> parse_long_stamp(std::string_view text) {
  constexpr std::size_t kNanosecondDigits = 19;
  constexpr std::size_t kMicrosecondDigits = 16;
  constexpr std::size_t kMillisecondDigits = 13;
  constexpr std::size_t kSecondDigits = 9;
  if (all_digits(text)) {
    std::int64_t unit_ns = 0;
    if (text.size() == kNanosecondDigits || (text.size() + 1 == kNanosecondDigits && text.front() != '0')) unit_ns = 1;
    if (text.size() == kMicrosecondDigits) unit_ns = 1'000;
    if (text.size() == kMillisecondDigits && text.front() == '1') unit_ns = 1'000'000;
    const auto units = unit_ns > 0 ? parse_integer(text) : std::nullopt;
    std::int64_t nanoseconds = 0;
    if (!units || __builtin_mul_overflow(*units, unit_ns, &nanoseconds)) return std::nullopt;
    return nanoseconds;
  }
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos || point < kSecondDigits) return std::nullopt;
  if (!all_digits(text.substr(0, point)) || !all_digits(text.substr(point + 1))) return std::nullopt;
  return parse_stamp(text);
}

std::vector<std::int64_t> read_dates(const std::filesystem::path& file) {
  return read_lines(file, parse_date, "a date as 2011-09-26 13:02:25.951199337", "Unpack the drive again");
}

}  // namespace detail

std::vector<std::int64_t> read_stamps(const std::filesystem::path& file) {
  const auto parse = [](std::string_view text) {
    if (const auto date = detail::parse_date(text)) return date;
    if (const auto stamp = detail::parse_long_stamp(text)) return stamp;
    return parse_stamp(text);
  };
  return detail::read_lines(file, parse, "a date, seconds, or 19 digits of ns", "Correct the file, or move it away");
}

}  // namespace rilo
