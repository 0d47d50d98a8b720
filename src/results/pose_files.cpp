#include "results/pose_files.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "io/file_bytes.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "results/sweep_times.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

constexpr const char* kGivePoses = "Give a pose file, of the results of a run trajectory.tum or poses_lidar.txt";

constexpr std::size_t kKittiNumbers = 12;
constexpr std::size_t kTumNumbers = 8;

/// The first line that is neither blank nor a comment; empty when there is none within the first 64 KiB.
std::string first_line(const std::filesystem::path& file) {
  const detail::FileBytes start = detail::read_file(file, std::size_t{1} << 16);
  detail::LineScanner lines(start.view());
  while (const auto line = lines.next()) {
    const auto words = detail::words_of(*line);
    if (!words.empty() && words[0][0] != '#') return std::string(*line);
  }
  return "";
}

PoseFile without_stamps(const std::filesystem::path& file, const std::vector<SE3>& poses) {
  PoseFile result{file, {}, false, {}, {}};
  for (const SE3& T : poses) result.trajectory.push_back({0, T});
  return result;
}

PoseFile truth_of_data(const std::filesystem::path& data, GroundTruth truth, PoseInstant instant) {
  PoseFile result = without_stamps(truth.file, truth.T_world_lidar);
  result.warnings = std::move(truth.warnings);
  result.of_instant = parse_pose_instant(truth.instant).has_value();
  SweepTimes times = sweep_times(data, instant);
  result.stamped = !times.stamps_ns.empty() && times.stamps_ns.size() >= result.trajectory.size();
  if (!result.stamped) return result;
  for (std::size_t i = 0; i < result.trajectory.size(); ++i) result.trajectory[i].stamp_ns = times.stamps_ns[i];
  result.offsets_ns = std::move(times.offsets_ns);
  return result;
}

Trajectory later_by(Trajectory trajectory, std::int64_t offset_ns) {
  for (StampedPose& pose : trajectory) pose.stamp_ns = detail::stamp_difference(pose.stamp_ns, -offset_ns);
  return trajectory;
}

MatchedPoses by_stamp(const PoseFile& truth, const Trajectory& estimate, double max_gap_s) {
  const std::int64_t gap_ns = detail::nanoseconds(max_gap_s);
  if (truth.offsets_ns.empty()) return match_by_stamp(truth.trajectory, estimate, gap_ns);
  std::optional<MatchedPoses> best;
  std::string why_not;
  for (const std::int64_t offset_ns : truth.offsets_ns) {
    try {
      MatchedPoses matched = match_by_stamp(later_by(truth.trajectory, offset_ns), estimate, gap_ns);
      if (!best || matched.truth.size() > best->truth.size()) best = std::move(matched);
    } catch (const std::invalid_argument& error) {
      if (why_not.empty()) why_not = error.what();
    }
  }
  if (!best) throw std::invalid_argument(why_not);
  return *best;
}

// Of both, as many as there are of the shorter one.
MatchedPoses by_index(Trajectory truth, Trajectory estimate, std::size_t first) {
  truth.erase(truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(std::min(first, truth.size())));
  const std::size_t both = std::min(truth.size(), estimate.size());
  truth.resize(both);
  estimate.resize(both);
  return match_by_index(truth, estimate);
}

PairedPoses paired_by_stamp(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options) {
  try {
    return {by_stamp(truth, estimate.trajectory, options.max_gap_s),
            fmt::format("paired by stamp, at most {} s apart", options.max_gap_s),
            {},
            true};
  } catch (const std::invalid_argument& error) {
    const bool enough = truth.trajectory.size() > 1 && estimate.trajectory.size() > 1;
    throw std::invalid_argument(error.what() +
                                std::string(enough && options.index_advised ? ", or take --associate index" : ""));
  }
}

PairedPoses paired_by_index(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options) {
  PairedPoses paired{by_index(truth.trajectory, estimate.trajectory, options.first),
                     fmt::format("paired by index from true pose {} on", options.first),
                     {},
                     false};
  const std::size_t in_truth = truth.trajectory.size() - std::min(options.first, truth.trajectory.size());
  const std::size_t in_estimate = estimate.trajectory.size();
  if (in_truth != in_estimate) {
    paired.warnings.push_back(
        fmt::format("{} true and {} estimated poses: the first {} are paired one after the other, which is wrong when "
                    "the estimate begins later (--start tells where) or lacks a sweep (stamps of both tell which)",
                    in_truth, in_estimate, paired.poses.truth.size()));
  }
  return paired;
}

PairedPoses paired_automatically(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options) {
  const std::size_t all = estimate.trajectory.size();
  const bool index_fits = !truth.offsets_ns.empty() && truth.trajectory.size() == all;
  if (!index_fits) return paired_by_stamp(truth, estimate, options);
  try {
    PairedPoses paired = paired_by_stamp(truth, estimate, options);
    if (paired.poses.truth.size() == all) return paired;
  } catch (const std::invalid_argument&) {
    // Of another clock.
  }
  return paired_by_index(truth, estimate, options);
}

}  // namespace

PoseFile read_poses(const std::filesystem::path& file) {
  if (detail::is_folder(file)) {
    const std::filesystem::path poses = file / "poses_lidar.txt";
    const bool of_run = detail::is_file(poses);
    throw IoError({file, "", "a folder", "a pose file", of_run ? "Give " + poses.string() : kGivePoses});
  }
  if (!detail::is_file(file)) return without_stamps(file, read_kitti_poses(file));
  const std::string line = first_line(file);
  if (line.find(',') != std::string::npos) return {file, read_euroc(file), true, {}, {}};
  const std::size_t count = detail::words_of(line).size();
  if (count == kTumNumbers) return {file, read_tum(file), true, {}, {}};
  if (count == kKittiNumbers) return without_stamps(file, read_kitti_poses(file));
  if (count == 0) throw IoError({file, "", "no pose", "a pose file, KITTI, TUM or EuRoC form", "Check the path"});
  throw IoError({file, "first line", detail::counted(count, "word"),
                 "12 numbers (KITTI form), 8 (TUM form), or 8 with commas (EuRoC form)", kGivePoses});
}

PoseFile read_truth(const std::filesystem::path& path, PoseInstant instant) {
  if (!detail::is_folder(path)) return read_poses(path);
  auto truth = read_ground_truth(path, instant);
  if (truth) return truth_of_data(path, std::move(*truth), instant);
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
    throw RunError(
        RunErrorKind::kUsage,
        "--associate stamp needs stamps of both; a KITTI pose file has none, nor have data without a list of "
        "increasing stamps");
  }
  const std::size_t in_truth = truth.trajectory.size();
  const std::size_t in_estimate = estimate.trajectory.size();
  PairedPoses paired;
  try {
    if (options.pairing == Pairing::kStamp) {
      paired = paired_by_stamp(truth, estimate, options);
    } else if (stamped && options.pairing == Pairing::kAuto) {
      paired = paired_automatically(truth, estimate, options);
    } else {
      paired = paired_by_index(truth, estimate, options);
    }
  } catch (const std::invalid_argument& error) {
    throw RunError(RunErrorKind::kBadData,
                   fmt::format("{} ({}) and {} ({}): {}", truth.file.string(), detail::counted(in_truth, "pose"),
                               estimate.file.string(), detail::counted(in_estimate, "pose"), error.what()));
  }
  paired.protocol +=
      fmt::format("; {} of {} true and {} estimated poses", paired.poses.truth.size(), in_truth, in_estimate);
  paired.warnings.insert(paired.warnings.begin(), truth.warnings.begin(), truth.warnings.end());
  return paired;
}

}  // namespace rilo
