// This build has no librosbag-storage.
#include "io/ros/recording.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_recording.hpp"

namespace rilo::detail {

std::unique_ptr<Recording> open_bag(const std::filesystem::path& file) {
  throw IoError({file, "", "a ROS 1 bag, and this build reads none", "a build with librosbag-storage",
                 "Install librosbag-storage-dev, libnav-msgs-dev and libtf2-msgs-dev and build again, or convert the "
                 "bag to MCAP"});
}

}  // namespace rilo::detail

namespace rilo {

bool can_write_bags() { return false; }

void write_bag(const std::filesystem::path& file, std::span<const SweepResult> /*results*/,
               const RecordingNames& /*names*/) {
  throw IoError(
      {file, "", "a ROS 1 bag, and this build writes none", "a build with librosbag-storage",
       "Install librosbag-storage-dev, libnav-msgs-dev and libtf2-msgs-dev and build again, or use the MCAP"});
}

}  // namespace rilo
