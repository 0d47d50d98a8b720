#include "embedded_json.hpp"

#include <cmath>

namespace rilo {

nlohmann::json rounded(double value) {
  return std::isfinite(value) ? nlohmann::json(std::round(value * 1e4) / 1e4) : nlohmann::json(nullptr);
}

std::string embedded_json(const nlohmann::json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe = "<script type=\"application/json\">";  // "</script>" and "<!--" must not appear inside
  safe.reserve(safe.size() + text.size() + 10);
  for (const char c : text) {
    safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  }
  return safe + "</script>\n";
}

}  // namespace rilo
