// Captures: link layers, fragments, and the packets of Velodynes.
#include "harness.hpp"
#include "io/packets/packet_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::MemoryFile file(rilo::fuzz::bytes_of(data, size));
  rilo::fuzz::only_io_errors([&] {
    const auto source = rilo::detail::open_captures(file.path(), {file.path()}, {});
    rilo::fuzz::read_all(*source);
  });
  return 0;
}
