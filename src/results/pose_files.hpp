// Trajectories of unknown form, and pairing them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/association.hpp"
#include "io/folders/ground_truth.hpp"

namespace rilo {

struct PoseFile {
  std::filesystem::path file;
  Trajectory trajectory;
  bool stamped = false;  ///< TUM form, or of data with stamps
  /// Of a data folder: an estimate's poses may be stamped so much later than the sweeps, the likeliest first.
  std::vector<std::int64_t> offsets_ns = {};
  std::vector<std::string> warnings = {};
  bool of_instant = false;  ///< of a data folder that has poses of several times of the sweeps
};

/// KITTI form (12 numbers a line) or TUM form (8), detected from the first line. @throws IoError
PoseFile read_poses(const std::filesystem::path& file);

/// The same, or the ground truth of a data folder for that time of the sweeps, with their stamps where files show them.
/// @throws IoError
PoseFile read_truth(const std::filesystem::path& path, PoseInstant instant);

/// Auto: by stamp when both have stamps. Where those of a data folder do not fit all poses (another clock, stamps that
/// were evened out), as many poses as sweeps are paired by index.
enum class Pairing { kAuto, kIndex, kStamp };

/// "auto", "index" or "stamp".
Pairing parse_pairing(const std::string& text);

struct PairingOptions {
  Pairing pairing = Pairing::kAuto;
  double max_gap_s = 0.02;
  std::size_t first = 0;       ///< by index: the true pose that belongs to the first estimate
  bool index_advised = false;  ///< there is an option --associate
};

struct PairedPoses {
  MatchedPoses poses;
  std::string protocol;               ///< how they were paired, and what was dropped
  std::vector<std::string> warnings;  ///< of the truth, and when it may be wrong
  bool by_stamp = false;
};

/// @throws RunError when the two cannot be paired so.
PairedPoses pair_poses(const PoseFile& truth, const PoseFile& estimate, const PairingOptions& options);

}  // namespace rilo
