// An Ouster's metadata up to the first zero byte, then its packets.
#include "io/packets/ouster.hpp"

#include <deque>

#include "harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::Halves halves = rilo::fuzz::split(rilo::fuzz::bytes_of(data, size));
  const std::string_view packets = halves.second;
  const rilo::fuzz::MemoryFile file(halves.first);
  rilo::fuzz::only_io_errors([&] {
    const auto metadata = rilo::detail::read_ouster_metadata(file.path());
    const std::size_t bytes = rilo::detail::ouster_packet_bytes(metadata);
    const auto decoder = rilo::detail::ouster_decoder(metadata);
    std::deque<rilo::detail::DecodedSweep> done;
    std::int64_t received_ns = 0;
    for (std::size_t at = 0; bytes > 0 && at < packets.size(); at += bytes) {
      std::string packet(packets.substr(at, bytes));
      packet.resize(bytes);  // the last is filled up
      if (!decoder->accepts(packet)) std::abort();
      decoder->take(packet, received_ns += 100'000, done);
    }
    decoder->finish(done);
  });
  return 0;
}
