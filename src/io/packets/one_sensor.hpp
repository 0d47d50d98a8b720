// Of several sensors in a recording the first one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/packets/packet_stream.hpp"

namespace rilo::detail {

/// Sensors differ by their address and by the port that they send to. Their own port may change when they start again.
class OneSensor {
 public:
  /// Whether the packet is from where the first one came from; others are counted.
  bool takes(const Datagram& datagram);
  /// Counts a packet that says itself that it is another sensor's.
  void leave_out(const Datagram& datagram);

  /// One for each of the others.
  std::vector<std::string> warnings() const;

 private:
  using Origin = std::pair<std::string, std::uint16_t>;  // the address, as in Datagram, and the port

  std::optional<Origin> first_;
  std::map<Origin, std::size_t> others_;
};

}  // namespace rilo::detail
