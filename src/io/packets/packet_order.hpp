// Packets that the network or the recorder has doubled or mixed up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

namespace rilo::detail {

/// Tells by the sensor's clock which packets come in order. A clock that jumps by more than a second was set, and
/// another order begins; after less its packets are too late for as long as sweeps would be.
class PacketOrder {
 public:
  enum class Arrival : std::uint8_t {
    kNext,    ///< newer than all before
    kLate,    ///< of the sweep that grows, but a newer one came before
    kDropped  ///< it came before, or is older than the sweep that grows
  };

  /// `wrap_ns`: period after which the sensor's clock wraps; 0: never.
  explicit PacketOrder(std::int64_t wrap_ns) : wrap_ns_(wrap_ns) {}

  /// `place`, an angle or a column, tells packets of the same time apart.
  Arrival arrival(std::int64_t sensor_ns, std::uint64_t place);

  /// The newest packet is the first of a sweep: older ones are too late.
  void begin_sweep() { taken_ns_.erase(taken_ns_.begin(), taken_ns_.lower_bound(newest_ns_)); }

  std::size_t dropped() const { return dropped_; }

 private:
  std::int64_t since_newest_ns(std::int64_t sensor_ns) const;
  Arrival next(std::int64_t time_ns, std::uint64_t place);

  std::int64_t wrap_ns_;
  std::set<std::int64_t> taken_ns_;  // of the sweep that grows, across the wraps of the clock
  std::int64_t newest_ns_ = 0;
  std::uint64_t newest_place_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace rilo::detail
