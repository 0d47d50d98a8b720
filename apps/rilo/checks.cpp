#include "checks.hpp"

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "io/text.hpp"

namespace rilo::cli {

CLI::Validator number_within(double least, double most) {
  return {[=](std::string& text) {
            const auto value = detail::parse_double(text);
            // False for NaN.
            if (value && *value >= least && *value <= most) return std::string();
            return fmt::format("\"{}\" is not a number from {} to {}", text, least, most);
          },
          ""};
}

CLI::Validator whole_number(std::int64_t most) {
  return {[=](std::string& text) {
            const auto value = detail::parse_integer(text);
            if (value && *value >= 0 && *value <= most) return std::string();
            if (most == kAnyCount) {
              return fmt::format("\"{}\" is not a non-negative integer", text);
            }
            return fmt::format("\"{}\" is not an integer from 0 to {}", text, most);
          },
          ""};
}

CLI::Validator path_given() {
  return {[](std::string& text) { return text.empty() ? std::string("a path was expected, not an empty word") : ""; },
          ""};
}

CLI::Validator frame_given() {
  return {[](std::string& text) {
            const bool empty = text.find_first_not_of('/') == std::string::npos;
            return empty ? "the name of a frame was expected, not \"" + text + '"' : "";
          },
          ""};
}

CLI::Option* add_number(CLI::App& command, const char* name, double& value, double least, double most,
                        const char* help) {
  return command.add_option(name, value, help)->check(number_within(least, most))->capture_default_str();
}

CLI::Option* add_choice(CLI::App& command, const char* name, const std::function<void(const std::string&)>& take,
                        std::vector<std::string> words, const char* help) {
  return command.add_option_function<std::string>(name, take, help)->check(CLI::IsMember(std::move(words)));
}

}  // namespace rilo::cli
