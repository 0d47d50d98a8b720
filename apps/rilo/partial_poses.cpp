#include "partial_poses.hpp"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "command.hpp"

namespace rilo::cli {

PartialPoses::PartialPoses(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  file_ = folder / "poses_lidar.partial.txt";
  open();
}

void PartialPoses::open() {
  stream_.open(file_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw CommandError(kCannotWrite, file_.string() + ": cannot be opened for writing");
}

void PartialPoses::add(const SE3& T_odom_lidar) {
  if (file_.empty()) return;
  std::string line;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      line += fmt::format("{}{:.12e}", line.empty() ? "" : " ", T_odom_lidar(row, column));
    }
  }
  line += '\n';
  stream_ << line << std::flush;
  if (stream_) {
    bytes_ += line.size();
    return;
  }
  stream_.close();
  std::error_code ignored;
  std::filesystem::resize_file(file_, bytes_, ignored);  // half a line would spoil the file
  throw CommandError(kCannotWrite, file_.string() + ": cannot be written; is the disk full?");
}

void PartialPoses::start_over() {
  if (file_.empty()) return;
  stream_.close();
  bytes_ = 0;
  open();
}

void PartialPoses::remove() {
  if (file_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace rilo::cli
