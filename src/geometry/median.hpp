// The median, where the order of the values does not matter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace rilo {

/// The middle one of the sorted values, of an even number the upper one of the two. Reorders them; there is at least
/// one.
template <typename T>
T upper_median(std::span<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace rilo
