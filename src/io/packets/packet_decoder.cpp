#include "io/packets/packet_decoder.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "io/stamp_difference.hpp"

namespace rilo::detail {

std::int64_t PacketClock::nearest(std::int64_t time_ns, std::int64_t to_ns) const {
  if (wrap_ns_ == 0) return time_ns;
  const std::int64_t turns = (to_ns - time_ns + wrap_ns_ / 2) / wrap_ns_;
  const std::int64_t candidate = time_ns + turns * wrap_ns_;
  return candidate - to_ns > wrap_ns_ / 2 ? candidate - wrap_ns_ : candidate;
}

std::int64_t PacketClock::stamp_ns(std::int64_t sensor_ns, std::int64_t received_ns) {
  constexpr std::int64_t kApart = 1'000'000'000;
  // Clocks of damaged packets must not overflow.
  constexpr std::int64_t kLargest = std::int64_t{1} << 61;
  sensor_ns = std::clamp(sensor_ns, -kLargest, kLargest);
  received_ns = std::clamp(received_ns, -kLargest, kLargest);
  std::int64_t stamp = nearest(sensor_ns + offset_ns_, received_ns);
  if (std::abs(stamp - received_ns) <= kApart) {
    set_ = true;
    return stamp;
  }
  resets_ += set_ ? 1 : 0;
  set_ = true;
  offset_ns_ = received_ns - sensor_ns;
  return received_ns;
}

void GrowingSweep::add(const Eigen::Vector3f& point, float intensity, std::uint16_t ring, std::int64_t time_ns) {
  sweep_.points.push_back(point);
  sweep_.intensities.push_back(intensity);
  sweep_.rings.push_back(ring);
  times_ns_.push_back(time_ns);
}

Sweep GrowingSweep::take() {
  Sweep sweep = std::exchange(sweep_, {});
  const std::vector<std::int64_t> times_ns = std::exchange(times_ns_, {});
  if (times_ns.empty()) return sweep;
  sweep.stamp_ns = *std::min_element(times_ns.begin(), times_ns.end());
  sweep.times_s.reserve(times_ns.size());
  for (const std::int64_t time : times_ns) {
    sweep.times_s.push_back(static_cast<float>(seconds_between(sweep.stamp_ns, time)));
  }
  return sweep;
}

}  // namespace rilo::detail
