// The known word nearest to a given one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rilo {

/// Levenshtein's distance: insertions, deletions and replacements. Of longer texts only the first 100 bytes count.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that is meant by `word`: one of which it is the beginning or that is its beginning, else the one
/// at the least edit distance when that is at most half of its length; empty when none is.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace rilo
