// Data for the script in the page.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace rilo {

/// Four decimals; JSON has no word for what is not finite, so it is null.
nlohmann::json rounded(double value);

/// A <script> element with `data`; nothing in it can end the element.
std::string embedded_json(const nlohmann::json& data);

}  // namespace rilo
