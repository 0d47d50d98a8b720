#include "checks.hpp"

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace rilo::cli {

namespace {

template <typename Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

CLI::Validator number_within(double least, double most) {
  return {[=](std::string& text) {
            const auto value = parse<double>(text);
            // False for NaN.
            if (value && *value >= least && *value <= most) return std::string();
            return fmt::format("\"{}\" is not a number from {} to {}", text, least, most);
          },
          ""};
}

CLI::Validator whole_number(std::int64_t most) {
  return {[=](std::string& text) {
            const auto value = parse<std::int64_t>(text);
            if (value && *value >= 0 && *value <= most) return std::string();
            if (most == std::numeric_limits<std::int64_t>::max()) {
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

}  // namespace rilo::cli
