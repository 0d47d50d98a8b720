// Text, numbers and data as HTML wants them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace rilo {

/// `text` with & < > " ' replaced by entities and control characters by spaces.
std::string escaped(std::string_view text);

/// `value` with `digits` decimals; an en dash when it is not finite or absent.
std::string number(double value, int digits);
std::string number(const std::optional<double>& value, int digits);

/// Four decimals; JSON has no word for what is not finite, so it is null.
nlohmann::json rounded(double value);

/// A <script> element with `data`; nothing in it can end the element.
std::string embedded_json(const nlohmann::json& data);

}  // namespace rilo
