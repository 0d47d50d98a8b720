// UDP datagrams of a pcap or pcapng recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/packets/packet_stream.hpp"

struct pcap;

namespace rilo::detail {

/// Reads with libpcap. Ethernet (VLANs too), Linux cooked, loopback and raw captures; IPv4, put together again when it
/// was fragmented, and unfragmented IPv6.
class UdpReader final : public PacketStream {
 public:
  /// @throws IoError when the file is not a capture, or of a link type that we do not know.
  explicit UdpReader(std::filesystem::path file);
  ~UdpReader() override;
  UdpReader(const UdpReader&) = delete;
  UdpReader& operator=(const UdpReader&) = delete;

  /// The next datagram, or nothing at the end. A capture that is cut off ends there, with a warning.
  std::optional<Datagram> next() override;

  bool is_mixed() const override { return true; }
  bool shortened() const override { return shortened_; }
  std::vector<std::string> warnings() const override;

 private:
  struct Fragments {
    std::uint64_t addresses = 0;  // of the sender and the receiver
    std::uint16_t number = 0;     // of the datagram
    std::int64_t begun_ns = 0;    // when its first part came
    std::vector<std::size_t> offsets;
    std::string bytes;
    std::size_t received = 0;
    std::optional<std::size_t> total;
  };
  struct Close {
    void operator()(pcap* capture) const;
  };

  std::optional<std::string_view> network_layer(std::string_view frame) const;
  std::optional<Datagram> from_ip(std::string_view packet);
  std::optional<std::string_view> put_together(std::string_view packet, std::size_t header, std::size_t offset,
                                               bool more);
  void forget_old_fragments();
  static std::optional<Datagram> from_udp(std::string_view udp, std::string_view sender);

  std::filesystem::path file_;
  std::unique_ptr<pcap, Close> capture_;
  int link_ = 0;
  std::int64_t bytes_when_opened_ = 0;
  bool shortened_ = false;
  std::int64_t received_ns_ = 0;  // when the present packet came
  std::deque<Fragments> fragments_;
  std::string whole_;  // the datagram put together last
  std::size_t cut_packets_ = 0;
  std::string end_;  // why the capture ended early
};

}  // namespace rilo::detail
