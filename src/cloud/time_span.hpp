// From the first to the last time of some points.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace rilo {

struct TimeSpan {
  float begin_s = std::numeric_limits<float>::infinity();
  float end_s = -std::numeric_limits<float>::infinity();

  bool empty() const { return begin_s > end_s; }
  float length_s() const { return end_s - begin_s; }
  bool contains(float time_s) const { return time_s >= begin_s && time_s <= end_s; }
  bool contains(const TimeSpan& other) const { return contains(other.begin_s) && contains(other.end_s); }

  void widen(const TimeSpan& other) {
    begin_s = std::min(begin_s, other.begin_s);
    end_s = std::max(end_s, other.end_s);
  }
};

/// Of the times of valid points without two percent at either end. Empty: there are none.
inline TimeSpan bulk_of(std::span<const float> times_s, std::span<const std::uint8_t> valid) {
  constexpr std::size_t kPerEnd = 50;  // one in so many
  std::vector<float> times;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (valid[i] != 0) {
      times.push_back(times_s[i]);
    }
  }
  if (times.empty()) {
    return {};
  }
  const auto cut = static_cast<std::ptrdiff_t>(times.size() / kPerEnd);
  std::nth_element(times.begin(), times.begin() + cut, times.end());
  const float begin_s = times[static_cast<std::size_t>(cut)];
  std::nth_element(times.begin(), times.end() - 1 - cut, times.end());
  return {begin_s, *(times.end() - 1 - cut)};
}

}  // namespace rilo
