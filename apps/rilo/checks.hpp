// Options whose values are checked one by one.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace rilo::cli {

/// A number from `least` to `most`; unlike CLI::Range not NaN.
CLI::Validator number_within(double least, double most);

/// A number of things: CLI11 itself would wrap -1 around.
inline constexpr std::int64_t kAnyCount = std::numeric_limits<std::int64_t>::max();
CLI::Validator whole_number(std::int64_t most = kAnyCount);

/// Not empty: an unset variable of a script is not a path.
CLI::Validator path_given();

/// The same for a frame of ROS, also without the slash that some begin with.
CLI::Validator frame_given();

/// Options with such checks; the help shows their defaults.
CLI::Option* add_number(CLI::App& command, const char* name, double& value, double least, double most,
                        const char* help);
template <typename Count>
CLI::Option* add_count(CLI::App& command, const char* name, Count& value, std::int64_t most, const char* help) {
  return command.add_option(name, value, help)->check(whole_number(most))->capture_default_str();
}

/// An option with a fixed set of words.
CLI::Option* add_choice(CLI::App& command, const char* name, const std::function<void(const std::string&)>& take,
                        std::vector<std::string> words, const char* help);

}  // namespace rilo::cli
