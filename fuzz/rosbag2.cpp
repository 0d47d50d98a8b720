// A rosbag2 folder: metadata.yaml up to the first zero byte, then the file `a` that it should name, SQLite3 or packed.
#include <fstream>

#include "harness.hpp"
#include "io/ros/recording_source.hpp"

namespace {

namespace fs = std::filesystem;

// Of this process, so that several may run.
const fs::path& folder() {
  static const fs::path kPath = [] {
    fs::path made = fs::temp_directory_path() / ("rilo-fuzz-" + std::to_string(::getpid()));
    fs::create_directories(made);
    std::atexit([] { fs::remove_all(folder()); });
    return made;
  }();
  return kPath;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto [metadata, storage] = rilo::fuzz::split(rilo::fuzz::bytes_of(data, size));
  std::ofstream(folder() / "metadata.yaml", std::ios::binary) << metadata;
  for (const char* name : {"a.db3", "a.db3.zstd"}) std::ofstream(folder() / name, std::ios::binary) << storage;
  rilo::fuzz::only_io_errors([&] {
    const auto source = rilo::detail::open_recording(folder(), rilo::detail::open_rosbag2(folder()), {});
    rilo::fuzz::read_all(*source);
  });
  return 0;
}
