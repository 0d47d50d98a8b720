#include "results/pose_files.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

constexpr std::size_t kKittiNumbers = 12;
constexpr std::size_t kTumNumbers = 8;

/// Words on the first line that is neither blank nor a comment; 0 when there is none within the first 64 KiB.
std::size_t words_of_first_line(const std::filesystem::path& file) {
  const detail::FileBytes start = detail::read_file(file, std::size_t{1} << 16);
  detail::LineScanner lines(start.view());
  while (const auto line = lines.next()) {
    const auto words = detail::words_of(*line);
    if (!words.empty() && words[0][0] != '#') return words.size();
  }
  return 0;
}

PoseFile without_stamps(const std::filesystem::path& file, const std::vector<SE3>& poses) {
  PoseFile result{file, {}, false};
  for (const SE3& T : poses) result.trajectory.push_back({0, T});
  return result;
}

MatchedPoses by_index(Trajectory truth, const Trajectory& estimate, std::size_t first) {
  truth.erase(truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(std::min(first, truth.size())));
  truth.resize(std::min(truth.size(), estimate.size()));
  return match_by_index(truth, estimate);
}

}  // namespace

PoseFile read_poses(const std::filesystem::path& file) {
  const std::size_t count = std::filesystem::is_regular_file(file) ? words_of_first_line(file) : kKittiNumbers;
  if (count == kTumNumbers) return {file, read_tum(file), true};
  if (count == kKittiNumbers) return without_stamps(file, read_kitti_poses(file));
  if (count == 0) throw IoError({file, "", "no pose", "a pose file, KITTI or TUM form", "Check the path"});
  throw IoError({file, "first line", fmt::format("{} words", count), "12 numbers (KITTI form) or 8 (TUM form)",
                 "Give a pose file"});
}

PoseFile read_truth(const std::filesystem::path& path, PoseInstant instant) {
  if (!std::filesystem::is_directory(path)) return read_poses(path);
  const auto truth = read_ground_truth(path, instant);
  if (truth) return without_stamps(truth->file, truth->T_world_lidar);
  throw IoError(
      {path, "", "no ground truth", "poses.txt, poses_mid.txt or poses_velo.txt in it", "Give the pose file itself"});
}

Pairing parse_pairing(const std::string& text) {
  static const std::map<std::string, Pairing> kPairings = {
      {"auto", Pairing::kAuto}, {"index", Pairing::kIndex}, {"stamp", Pairing::kStamp}};
  return kPairings.at(text);
}

PairedPoses pair_poses(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options) {
  const bool stamped = truth.stamped && estimate.stamped;
  if (options.pairing == Pairing::kStamp && !stamped) {
    throw RunError(RunErrorKind::kUsage, "--associate stamp needs stamps in both files; a KITTI pose file has none");
  }
  const std::size_t in_truth = truth.trajectory.size();
  const std::size_t in_estimate = estimate.trajectory.size();
  PairedPoses paired;
  try {
    if (stamped && options.pairing != Pairing::kIndex) {
      const auto gap_ns = static_cast<std::int64_t>(std::llround(options.max_gap_s * 1e9));
      paired.poses = match_by_stamp(truth.trajectory, estimate.trajectory, gap_ns);
      paired.protocol = fmt::format("paired by stamp, at most {} s apart", options.max_gap_s);
    } else {
      paired.poses = by_index(truth.trajectory, estimate.trajectory, options.first);
      paired.protocol = fmt::format("paired by index from true pose {} on", options.first);
    }
  } catch (const std::invalid_argument& error) {
    throw RunError(RunErrorKind::kBadData, fmt::format("{} ({} poses) and {} ({} poses): {}", truth.file.string(),
                                                       in_truth, estimate.file.string(), in_estimate, error.what()));
  }
  paired.protocol +=
      fmt::format("; {} of {} true and {} estimated poses", paired.poses.truth.size(), in_truth, in_estimate);
  return paired;
}

}  // namespace rilo
