// This build has no librosbag-storage.
#include "io/ros/recording.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {

std::unique_ptr<Recording> open_bag(const std::filesystem::path& file) {
  throw IoError({file, "", "a ROS 1 bag, and this build reads none", "a build with librosbag-storage",
                 "Install librosbag-storage-dev and build again, or convert the bag to MCAP"});
}

}  // namespace rilo::detail
