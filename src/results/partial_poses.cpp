#include "results/partial_poses.hpp"

#include <string_view>

#include <fmt/format.h>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

constexpr std::string_view kSweepWord = "sweep";  // "# sweep 20"

}  // namespace

std::string partial_pose_line(const SE3& T_odom_lidar, std::size_t sweep, std::size_t expected) {
  const std::string line = kitti_line(T_odom_lidar);
  return sweep == expected ? line : fmt::format("# {} {}\n", kSweepWord, sweep) + line;
}

PosesSoFar read_partial_poses(const std::filesystem::path& file) {
  PosesSoFar so_far{read_growing_kitti_poses(file), {}};
  const detail::FileBytes bytes = detail::read_file(file);
  detail::LineScanner lines(bytes.view());
  std::size_t sweep = 0;
  while (so_far.sweeps.size() < so_far.poses.size()) {
    const auto line = lines.next();
    if (!line) break;  // a second pass has begun it anew meanwhile
    const auto words = detail::words_of(*line);
    if (words.empty()) continue;
    if (words[0][0] != '#') {
      so_far.sweeps.push_back(sweep++);
    } else if (words.size() == 3 && words[1] == kSweepWord) {
      sweep = static_cast<std::size_t>(detail::parse_unsigned(words[2]).value_or(sweep));
    }
  }
  so_far.poses.resize(so_far.sweeps.size(), SE3::Identity());
  return so_far;
}

}  // namespace rilo
