// This build has no librosbag-storage.
#include "io/ros/recording.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

// The build folder is configured again: only then does CMake look for the packages.
constexpr const char* kRemedy =
    "In Rilo's folder, run: sudo apt-get install librosbag-storage-dev libnav-msgs-dev libtf2-msgs-dev && "
    "cmake build/release && cmake --build build/release";

}  // namespace

namespace detail {

std::unique_ptr<Recording> open_bag(const std::filesystem::path& file) {
  throw IoError({file, "", "a ROS 1 bag, which this build cannot read", "a build with librosbag-storage",
                 std::string(kRemedy) + ". Or convert the bag to MCAP"});
}

}  // namespace detail

bool can_write_bags() { return false; }

void write_bag(const std::filesystem::path& file, std::span<const SweepResult> /*results*/,
               const RecordingNames& /*names*/) {
  throw IoError({file, "", "a ROS 1 bag, which this build cannot write", "a build with librosbag-storage",
                 std::string(kRemedy) + ". Or use the MCAP"});
}

}  // namespace rilo
