// Files with one stamp per line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace rilo::detail {

/// Whole stamps as data sets write them: 19 digits are ns (18 without a zero in front, too: Argoverse), 16 are µs, 13
/// of which the first is 1 are ms (of the years 2001 to 2033; other numbers have zeros in front), decimals with 9
/// digits or more before the point are seconds.
std::optional<std::int64_t> parse_long_stamp(std::string_view text);

/// Dates. Blank lines are skipped. @throws IoError with the line.
std::vector<std::int64_t> read_dates(const std::filesystem::path& file);

}  // namespace rilo::detail
