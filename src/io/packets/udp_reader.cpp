#include "io/packets/udp_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <pcap/pcap.h>
#include <sys/stat.h>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/raw_bytes.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr std::uint16_t kIpv4 = 0x0800;
constexpr std::uint16_t kIpv6 = 0x86DD;
constexpr std::uint8_t kUdp = 17;

// Network byte order.
std::uint16_t big_endian16(std::string_view bytes, std::size_t at) {
  return load_bytes<std::uint16_t>(bytes, at, true);
}

std::optional<std::string_view> after(std::string_view bytes, std::size_t count) {
  return bytes.size() >= count ? std::optional(bytes.substr(count)) : std::nullopt;
}

// A pcapng file may count 64 bits of seconds.
std::int64_t stamp_ns(std::int64_t seconds, std::int64_t ns) {
  std::int64_t stamp = 0;
  if (!__builtin_mul_overflow(seconds, std::int64_t{1'000'000'000}, &stamp) &&
      !__builtin_add_overflow(stamp, ns, &stamp)) {
    return stamp;
  }
  return seconds < 0 ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}

std::optional<std::string_view> after_ethernet(std::string_view frame) {
  std::size_t type_at = 12;
  while (frame.size() >= type_at + 2) {
    const std::uint16_t type = big_endian16(frame, type_at);
    if (type == kIpv4 || type == kIpv6) return frame.substr(type_at + 2);
    const bool vlan = type == 0x8100 || type == 0x88A8 || type == 0x9100;
    if (!vlan) return std::nullopt;
    type_at += 4;
  }
  return std::nullopt;
}

std::int64_t bytes_of(std::FILE* stream) {
  struct stat status {};
  return ::fstat(::fileno(stream), &status) == 0 ? static_cast<std::int64_t>(status.st_size) : 0;
}

}  // namespace

void UdpReader::Close::operator()(pcap* capture) const { pcap_close(capture); }

UdpReader::UdpReader(std::filesystem::path file) : file_(std::move(file)) {
  std::FILE* stream = is_file(file_) ? std::fopen(file_.c_str(), "rbe") : nullptr;
  if (stream == nullptr) throw IoError({file_, "", "it cannot be opened", "a readable pcap file", "Check the path"});
  bytes_when_opened_ = bytes_of(stream);
  std::array<char, PCAP_ERRBUF_SIZE> message{};
  capture_.reset(pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, message.data()));
  if (!capture_) {
    std::fclose(stream);
    throw IoError({file_, "", std::string("libpcap: ") + message.data(), "a pcap or pcapng recording",
                   "Check what kind of file this is, or record it again"});
  }
  link_ = pcap_datalink(capture_.get());
  constexpr std::array<int, 7> kKnown{DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_NULL, DLT_LOOP, DLT_RAW, 101};
  if (std::find(kKnown.begin(), kKnown.end(), link_) == kKnown.end()) {
    throw IoError({file_, "", "packets of link type " + std::to_string(link_),
                   "Ethernet, Linux cooked, loopback or raw IP", "Record at the network interface of the sensor"});
  }
}

UdpReader::~UdpReader() = default;

std::optional<std::string_view> UdpReader::network_layer(std::string_view frame) const {
  switch (link_) {
    case DLT_EN10MB:
      return after_ethernet(frame);
    case DLT_LINUX_SLL:
      return after(frame, 16);
    case DLT_LINUX_SLL2:
      return after(frame, 20);
    case DLT_NULL:
    case DLT_LOOP:
      return after(frame, 4);
    default:
      return frame;
  }
}

std::optional<Datagram> UdpReader::next() {
  while (capture_) {
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    const int code = pcap_next_ex(capture_.get(), &header, &data);
    if (code != 1) {
      if (code == PCAP_ERROR) end_ = pcap_geterr(capture_.get());
      // To libpcap that is an end like any other.
      shortened_ = bytes_of(pcap_file(capture_.get())) < bytes_when_opened_;
      if (shortened_) end_ = "the file has become shorter";
      capture_.reset();
      break;
    }
    const std::string_view frame(reinterpret_cast<const char*>(data), header->caplen);
    const auto packet = network_layer(frame);
    if (!packet) continue;
    if (header->caplen < header->len) {
      ++cut_packets_;
      continue;
    }
    received_ns_ = stamp_ns(header->ts.tv_sec, header->ts.tv_usec);  // nanoseconds, as asked for above
    if (auto datagram = from_ip(*packet)) {
      datagram->received_ns = received_ns_;
      return datagram;
    }
  }
  return std::nullopt;
}

std::optional<Datagram> UdpReader::from_ip(std::string_view packet) {
  constexpr std::size_t kIpv6Header = 40;
  const int version = packet.empty() ? 0 : static_cast<unsigned char>(packet[0]) >> 4;
  if (version == 6 && packet.size() > kIpv6Header && packet[6] == kUdp) {
    return from_udp(packet.substr(kIpv6Header), packet.substr(8, 16));
  }
  if (version != 4 || packet.size() < 20 || packet[9] != kUdp) return std::nullopt;
  const std::size_t header = 4 * (static_cast<unsigned char>(packet[0]) & 15U);
  const std::size_t total = big_endian16(packet, 2);
  if (header < 20 || total < header || total > packet.size()) return std::nullopt;
  packet = packet.substr(0, total);
  const std::string_view sender = packet.substr(12, 4);
  const std::uint16_t flags = big_endian16(packet, 6);
  const bool more = (flags & 0x2000) != 0;
  const std::size_t offset = std::size_t{8} * (flags & 0x1FFF);
  if (!more && offset == 0) return from_udp(packet.substr(header), sender);
  const auto whole = put_together(packet, header, offset, more);
  return whole ? from_udp(*whole, sender) : std::nullopt;
}

// A part of the datagram was lost, and soon another one has the same number.
void UdpReader::forget_old_fragments() {
  std::erase_if(fragments_, [&](const Fragments& open) {
    return std::abs(stamp_difference(received_ns_, open.begun_ns)) > kNanosecondsPerSecond;
  });
}

// Some datagrams at a time: an Ouster's are larger than what Ethernet carries.
std::optional<std::string_view> UdpReader::put_together(std::string_view packet, std::size_t header, std::size_t offset,
                                                        bool more) {
  constexpr std::size_t kMostOpen = 32;
  constexpr std::size_t kLargest = 65535;
  const auto addresses = load_bytes<std::uint64_t>(packet, 12);
  const auto number = load_bytes<std::uint16_t>(packet, 4);
  const Fragments none{addresses, number, received_ns_, {}, {}, 0, {}};
  forget_old_fragments();
  auto open = std::find_if(fragments_.begin(), fragments_.end(), [&](const Fragments& candidate) {
    return candidate.addresses == addresses && candidate.number == number;
  });
  if (open == fragments_.end()) {
    if (fragments_.size() == kMostOpen) fragments_.pop_front();
    fragments_.push_back(none);
    open = std::prev(fragments_.end());
  }
  const std::string_view part = packet.substr(header);
  if (offset + part.size() > kLargest) return std::nullopt;
  if (std::find(open->offsets.begin(), open->offsets.end(), offset) != open->offsets.end()) {
    if (std::string_view(open->bytes).substr(offset).starts_with(part)) return std::nullopt;  // it comes twice
    *open = none;  // of a later datagram: the sender gives one number to all
  }
  open->offsets.push_back(offset);
  if (open->bytes.size() < offset + part.size()) open->bytes.resize(offset + part.size());
  std::copy(part.begin(), part.end(), open->bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  open->received += part.size();
  if (!more) open->total = offset + part.size();
  if (!open->total || open->received < *open->total) return std::nullopt;
  whole_ = std::move(open->bytes);
  whole_.resize(std::min(whole_.size(), *open->total));
  fragments_.erase(open);
  return whole_;
}

std::optional<Datagram> UdpReader::from_udp(std::string_view udp, std::string_view sender) {
  constexpr std::size_t kHeader = 8;
  if (udp.size() < kHeader) return std::nullopt;
  const std::size_t length = big_endian16(udp, 4);
  if (length < kHeader || length > udp.size()) return std::nullopt;
  return Datagram{0, big_endian16(udp, 2), udp.substr(kHeader, length - kHeader), sender};
}

std::vector<std::string> UdpReader::warnings() const {
  std::vector<std::string> all;
  if (cut_packets_ > 0) {
    all.push_back(counted(cut_packets_, "packet") + " recorded in part only (record with a snaplen of 65535)");
  }
  if (!end_.empty()) all.push_back("the capture ends early: " + end_ + "; what comes before is used");
  return all;
}

}  // namespace rilo::detail
