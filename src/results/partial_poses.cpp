#include "results/partial_poses.hpp"

#include <string>
#include <system_error>

#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

PartialPoses::PartialPoses(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  file_ = folder / "poses_lidar.partial.txt";
  open();
}

void PartialPoses::open() {
  stream_.open(file_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw RunError(RunErrorKind::kCannotWrite, file_.string() + ": cannot be opened for writing");
}

void PartialPoses::on_registered(const RegisteredSweep& sweep) {
  if (file_.empty()) return;
  const std::string line = kitti_line(sweep.result.T_odom_lidar);
  stream_ << line << std::flush;
  if (stream_) {
    bytes_ += line.size();
    return;
  }
  stream_.close();
  std::error_code ignored;
  std::filesystem::resize_file(file_, bytes_, ignored);  // half a line would spoil the file
  throw RunError(RunErrorKind::kCannotWrite, file_.string() + ": cannot be written; is the disk full?");
}

void PartialPoses::on_restart(const Restart& /*restart*/) {
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

}  // namespace rilo
