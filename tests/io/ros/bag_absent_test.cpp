// What a build without librosbag-storage says: linked with that half of the io library alone.
#include <gtest/gtest.h>

#include "io/ros/recording.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

void expect_commands(const std::function<void()>& action) {
  try {
    action();
    FAIL() << "nothing was thrown";
  } catch (const IoError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("drive.bag: a ROS 1 bag, which this build cannot "), 0U) << text;
    // Every command, in an order that works: without the second, nothing is built again.
    const std::size_t install = text.find(
        "sudo apt-get install librosbag-storage-dev libnav-msgs-dev libtf2-msgs-dev && cmake build/release && "
        "cmake --build build/release");
    EXPECT_NE(install, std::string::npos) << text;
  }
}

TEST(BagAbsentTest, NamesTheCommands) {
  expect_commands([] { detail::open_bag("drive.bag"); });
  expect_commands([] { write_bag("drive.bag", {}); });
  EXPECT_FALSE(can_write_bags());
}

}  // namespace
}  // namespace rilo
