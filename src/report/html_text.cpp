#include "html_text.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace rilo {

std::string escaped(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr std::array<const char*, kSpecial.size()> kEntities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (const std::size_t k = kSpecial.find(c); k != std::string_view::npos) {
      result += kEntities[k];
    } else {
      result += static_cast<unsigned char>(c) < 0x20U && c != '\n' ? ' ' : c;
    }
  }
  return result;
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "–";
}

std::string number(const std::optional<double>& value, int digits) { return value ? number(*value, digits) : "–"; }

nlohmann::json rounded(double value) {
  return std::isfinite(value) ? nlohmann::json(std::round(value * 1e4) / 1e4) : nlohmann::json(nullptr);
}

std::string embedded_json(const nlohmann::json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe = "<script type=\"application/json\">";  // "</script>" and "<!--" must not appear inside
  safe.reserve(safe.size() + text.size() + 10);
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe + "</script>\n";
}

}  // namespace rilo
