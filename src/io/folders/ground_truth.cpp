#include "io/folders/ground_truth.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/file_bytes.hpp"
#include "io/folders/kitti_oxts.hpp"
#include "io/folders/scan_listing.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace fs = std::filesystem;
namespace {

std::optional<SE3> calibration_of(const fs::path& data) {
  const fs::path file = data / "calib.txt";
  return detail::is_file(file) ? read_kitti_calibration(file) : std::nullopt;
}

GroundTruth lidar_frame(const fs::path& file, std::string instant) {
  return {read_kitti_poses(file), file, std::move(instant), {}};
}

GroundTruth camera_frame(const fs::path& file, const SE3& T_cam_lidar) {
  return {camera_to_lidar(read_kitti_poses(file), T_cam_lidar), file, "stamp", {}};
}

// What a drive simulator says of its poses.txt ("end of the sweep"); "stamp" where nothing does.
std::string instant_of_poses(const fs::path& data) {
  const fs::path meta = data / "meta.json";
  if (!detail::is_file(meta)) return "stamp";
  const detail::FileBytes bytes = detail::read_file(meta);
  const auto json = nlohmann::json::parse(bytes.view(), nullptr, false);
  const auto found = json.find("reference_time");
  if (found == json.end() || !found->is_string()) return "stamp";
  const std::string text = found->get<std::string>();
  const std::string word = text.substr(0, text.find(' '));
  return parse_pose_instant(word) ? word : "stamp";
}

// KITTI odometry: sequences/NN beside poses/NN.txt.
fs::path official_poses(const fs::path& data) {
  std::error_code error;
  const fs::path folder = fs::canonical(data, error);
  return folder.parent_path().parent_path() / "poses" / (folder.filename().string() + ".txt");
}

std::optional<GroundTruth> find_truth(const fs::path& data, PoseInstant instant) {
  const std::string wanted(to_string(instant));
  if (const fs::path file = data / ("poses_" + wanted + ".txt"); detail::is_file(file))
    return lidar_frame(file, wanted);
  if (const fs::path file = data / "poses_velo.txt"; detail::is_file(file)) return lidar_frame(file, "stamp");
  const auto T_cam_lidar = calibration_of(data);
  if (const fs::path file = data / "poses.txt"; detail::is_file(file)) {
    GroundTruth truth = T_cam_lidar ? camera_frame(file, *T_cam_lidar) : lidar_frame(file, "stamp");
    truth.instant = instant_of_poses(data);
    if (!T_cam_lidar) {
      truth.warnings.emplace_back("no Tr in calib.txt: poses.txt is taken to be in the LiDAR frame");
    }
    return truth;
  }
  if (auto truth = detail::kitti_raw_truth(data)) return truth;
  const fs::path file = official_poses(data);
  if (!detail::is_folder(data / "velodyne") || !detail::is_file(file)) return std::nullopt;
  if (!T_cam_lidar) {
    throw IoError({file, "", "poses in the camera frame and no Tr in " + (data / "calib.txt").string(),
                   "the transform from LiDAR to camera", "Put KITTI's calib.txt into the sequence folder"});
  }
  return camera_frame(file, *T_cam_lidar);
}

void compare_counts(const fs::path& data, GroundTruth& truth) {
  std::size_t sweeps = 0;
  try {
    sweeps = detail::find_sweep_files(detail::sweep_folder(data)).files.size();
  } catch (const IoError&) {
    return;  // a recording: its sweeps are counted when they come
  }
  const std::size_t poses = truth.T_world_lidar.size();
  if (poses == sweeps) return;
  truth.warnings.push_back(truth.file.filename().string() + " has " + detail::counted(poses, "pose") + " for " +
                           detail::counted(sweeps, "sweep") + "; the first " + std::to_string(std::min(poses, sweeps)) +
                           " are compared");
  if (poses > sweeps) truth.T_world_lidar.resize(sweeps);
}

}  // namespace

std::optional<PoseInstant> parse_pose_instant(std::string_view text) {
  for (const PoseInstant value : {PoseInstant::kStart, PoseInstant::kMid, PoseInstant::kEnd}) {
    if (to_string(value) == text) return value;
  }
  return std::nullopt;
}

std::optional<GroundTruth> read_ground_truth(const fs::path& data, PoseInstant instant) {
  if (!detail::is_folder(data)) return std::nullopt;
  auto truth = find_truth(data, instant);
  if (!truth) return std::nullopt;
  // Spinning sensors stamp the middle of the sweep (KITTI); the others are half a sweep away.
  const bool at_stamps = truth->instant == "stamp";
  if (at_stamps ? instant != PoseInstant::kMid : truth->instant != to_string(instant)) {
    truth->warnings.push_back(truth->file.filename().string() + " is at the " +
                              (at_stamps ? "stamps" : truth->instant) + ", not at the " +
                              std::string(to_string(instant)) + " of the sweeps");
  }
  compare_counts(data, *truth);
  return truth;
}

}  // namespace rilo
