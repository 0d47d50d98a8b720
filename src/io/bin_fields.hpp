// The columns of a .bin record, as told.
#pragma once

#include <string>
#include <vector>

#include "io/cloud_columns.hpp"

namespace rilo::detail {

/// See SourceOptions::bin_fields. @throws std::invalid_argument when `text` makes no sense.
std::vector<Field> parse_bin_fields(const std::string& text);

}  // namespace rilo::detail
