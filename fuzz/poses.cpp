// The text files: poses, stamps, calibration.
#include "harness.hpp"
#include "rilo/io/trajectory_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rilo::fuzz::MemoryFile file(rilo::fuzz::bytes_of(data, size));
  rilo::fuzz::only_io_errors([&] { rilo::read_kitti_poses(file.path()); });
  rilo::fuzz::only_io_errors([&] { rilo::read_tum(file.path()); });
  rilo::fuzz::only_io_errors([&] { rilo::read_stamps(file.path()); });
  rilo::fuzz::only_io_errors([&] { rilo::read_kitti_calibration(file.path()); });
  return 0;
}
