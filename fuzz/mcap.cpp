// MCAP, its chunks, and the clouds in them.
#include "harness.hpp"
#include "io/ros/recording_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::MemoryFile file(rilo::fuzz::bytes_of(data, size));
  rilo::fuzz::only_io_errors([&] {
    const auto source = rilo::detail::open_recording(file.path(), rilo::detail::open_mcap(file.path()), {});
    rilo::fuzz::read_all(*source);
  });
  return 0;
}
