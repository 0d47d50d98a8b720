// Trajectories of unknown form, and pairing them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "evaluation/association.hpp"
#include "io/ground_truth.hpp"

namespace rilo {

struct PoseFile {
  std::filesystem::path file;
  Trajectory trajectory;
  bool stamped = false;  ///< TUM form
};

/// KITTI form (12 numbers a line) or TUM form (8), detected from the first line. @throws IoError
PoseFile read_poses(const std::filesystem::path& file);

/// The same, or the ground truth of a data folder for that time of the sweeps. @throws IoError
PoseFile read_truth(const std::filesystem::path& path, PoseInstant instant);

enum class Pairing { kAuto, kIndex, kStamp };

/// "auto", "index" or "stamp".
Pairing parse_pairing(const std::string& text);

struct PairingOptions {
  Pairing pairing = Pairing::kAuto;  ///< auto: by stamp when both files have stamps
  double max_gap_s = 0.02;
  std::size_t first = 0;  ///< by index: the true pose that belongs to the first estimate
};

struct PairedPoses {
  MatchedPoses poses;
  std::string protocol;  ///< how they were paired, and what was dropped
};

/// @throws RunError when the two cannot be paired so.
PairedPoses pair_poses(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options);

}  // namespace rilo
