// Records of float32, with all their columns.
#include "harness.hpp"
#include "rilo/io/cloud_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::MemoryFile file(rilo::fuzz::bytes_of(data, size));
  rilo::fuzz::only_io_errors([&] { rilo::read_bin(file.path()); });
  rilo::fuzz::only_io_errors([&] { rilo::read_bin(file.path(), "x,y,z,intensity,time,ring,_"); });
  return 0;
}
