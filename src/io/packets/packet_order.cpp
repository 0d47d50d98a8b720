#include "io/packets/packet_order.hpp"

#include <cstdlib>

#include "io/stamp_difference.hpp"

namespace rilo::detail {
namespace {

// No network holds a packet back for longer; a sweep that is older by more was not late, either.
constexpr std::int64_t kLatestNs = kNanosecondsPerSecond;

}  // namespace

PacketOrder::Arrival PacketOrder::arrival(std::int64_t sensor_ns, std::uint64_t place) {
  const std::int64_t since_ns = since_newest_ns(sensor_ns);
  if (taken_ns_.empty() || std::abs(since_ns) > kLatestNs) {
    taken_ns_.clear();
    return next(sensor_ns, place);
  }
  const std::int64_t time_ns = newest_ns_ + since_ns;
  // A clock may stand still.
  if (since_ns > 0 || (since_ns == 0 && place != newest_place_)) return next(time_ns, place);
  if (time_ns > *taken_ns_.begin() && taken_ns_.insert(time_ns).second) return Arrival::kLate;
  ++dropped_;
  return Arrival::kDropped;
}

std::int64_t PacketOrder::since_newest_ns(std::int64_t sensor_ns) const {
  const std::int64_t since_ns = stamp_difference(sensor_ns, newest_ns_);
  if (wrap_ns_ == 0) return since_ns;
  const std::int64_t forward_ns = (since_ns % wrap_ns_ + wrap_ns_) % wrap_ns_;
  return forward_ns < wrap_ns_ / 2 ? forward_ns : forward_ns - wrap_ns_;
}

PacketOrder::Arrival PacketOrder::next(std::int64_t time_ns, std::uint64_t place) {
  newest_ns_ = time_ns;
  newest_place_ = place;
  // A sweep may go on for ever: the motor stands still.
  while (!taken_ns_.empty() && *taken_ns_.begin() < time_ns - kLatestNs) taken_ns_.erase(taken_ns_.begin());
  taken_ns_.insert(taken_ns_.end(), time_ns);
  return Arrival::kNext;
}

}  // namespace rilo::detail
