#include "io/packets/one_sensor.hpp"

#include <arpa/inet.h>
#include <array>

#include "io/text.hpp"

namespace rilo::detail {
namespace {

std::string address_text(const std::string& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = address.size() == 4 ? AF_INET : AF_INET6;
  return inet_ntop(family, address.data(), text.data(), text.size()) == nullptr ? "" : text.data();
}

}  // namespace

bool OneSensor::takes(const Datagram& datagram) {
  if (!first_) first_ = Origin(datagram.sender, datagram.port);
  if (first_->first == datagram.sender && first_->second == datagram.port) return true;
  leave_out(datagram);
  return false;
}

void OneSensor::leave_out(const Datagram& datagram) {
  constexpr std::size_t kMostNamed = 8;
  Origin origin(datagram.sender, datagram.port);
  if (others_.size() >= kMostNamed && !others_.contains(origin)) origin = {};
  ++others_[origin];
}

std::vector<std::string> OneSensor::warnings() const {
  std::vector<std::string> all;
  for (const auto& [origin, count] : others_) {
    const auto& [address, port] = origin;
    all.push_back("dropped " + counted(count, "packet") +
                  (address.empty()
                       ? " of other sensors"
                       : " of another sensor, from " + address_text(address) + " to port " + std::to_string(port)));
  }
  return all;
}

}  // namespace rilo::detail
