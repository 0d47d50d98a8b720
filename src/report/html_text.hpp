// Text and numbers as HTML wants them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rilo {

/// `text` with & < > " ' replaced by entities and control characters by spaces.
std::string escaped(std::string_view text);

/// `value` with `digits` decimals; an en dash when it is not finite or absent.
std::string number(double value, int digits);
std::string number(const std::optional<double>& value, int digits);

}  // namespace rilo
