// A simulated drive as a KITTI-style folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {

/// What was written.
struct DriveSummary {
  std::size_t sweeps = 0;
  std::size_t points = 0;
  double path_m = 0;  ///< metres driven
};

/// Called after each sweep with the number written so far and in all; false stops the drive there.
using DriveProgress = std::function<bool(std::size_t done, std::size_t total)>;

/// Writes velodyne/%06d.bin (float32 x y z intensity), times_pt/%06d.bin (float32, fraction 0 … 1 of the sweep; raw
/// drives only), times.txt (s, start of each sweep), calib.txt (identity), poses_{start,mid,end}.txt and poses.txt
/// (LiDAR frame, 12 numbers a line; mid when deskewed, else end), and last of all meta.json: a folder without meta.json
/// is an unfinished drive. No file has its name before all of it is written. Stopping early (`progress` returns false)
/// leaves a valid, shorter drive. The folder is created; it may exist when it is empty or holds a drive that this one
/// replaces. Two at a time into one folder are the caller's to prevent.
/// @throws std::runtime_error naming the path and the system's reason when something cannot be written, or when the
/// folder holds anything else.
DriveSummary write_drive(const DriveSimulator& drive, const std::filesystem::path& folder,
                         const DriveProgress& progress = {});

}  // namespace rilo
