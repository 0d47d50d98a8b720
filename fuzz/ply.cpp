// PLY: header, ascii, binary of both byte orders.
#include "harness.hpp"
#include "rilo/io/cloud_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::MemoryFile file(rilo::fuzz::bytes_of(data, size));
  rilo::fuzz::only_io_errors([&] { rilo::read_ply(file.path()); });
  return 0;
}
