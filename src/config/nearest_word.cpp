#include "config/nearest_word.hpp"

#include <algorithm>
#include <numeric>

namespace rilo {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  constexpr std::size_t kCompared = 100;  // the table of the distance is quadratic
  a = a.substr(0, kCompared);
  b = b.substr(0, kCompared);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const std::string& candidate : known) {
    if (word.empty() || candidate.empty()) continue;
    const bool begins = candidate.starts_with(word) || word.starts_with(candidate);
    const std::size_t distance = begins ? 1 : edit_distance(word, candidate);
    const bool near = begins || 2 * distance <= candidate.size();
    if (near && distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rilo
