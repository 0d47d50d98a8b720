// Checks of single values on the command line.
#pragma once

#include <cstdint>
#include <limits>

#include <CLI/CLI.hpp>

namespace rilo::cli {

/// A number from `least` to `most`; unlike CLI::Range not NaN.
CLI::Validator number_within(double least, double most);

/// A number of things: CLI11 itself would wrap -1 around.
CLI::Validator whole_number(std::int64_t most = std::numeric_limits<std::int64_t>::max());

/// Not empty: an unset variable of a script is not a path.
CLI::Validator path_given();

}  // namespace rilo::cli
