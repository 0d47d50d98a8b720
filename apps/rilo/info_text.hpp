// The JSON of rilo info, for people.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace rilo::cli {

/// Of a data set, with what to run next. `options` on how it was read, as typed, are part of that.
std::string info_text(const nlohmann::json& info, const std::string& options);

/// Of a recording with several topics to choose from.
std::string topics_text(const nlohmann::json& topics);

}  // namespace rilo::cli
