// The calibration files of KITTI raw, which lie beside the drives of a day.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo::detail {

/// The numbers behind `key` ("R:"); other words are skipped. Empty when there is no such line.
std::vector<double> calibration_row(const std::filesystem::path& file, std::string_view key);

/// What to do about a file that is missing or damaged.
inline constexpr const char* kCalibrationRemedy =
    "Download the day's calibration from KITTI's raw data page and unpack it beside the drive";

/// The transform of `R:` (row by row) and `T:` (m), its rotation as the file has it. @throws IoError when a row is
/// missing, has another number of entries, or R is no rotation.
SE3 calibration_transform(const std::filesystem::path& file);

/// The rotation behind `key`, row by row, as the file has it. @throws IoError when it is missing or is none.
Eigen::Matrix3d calibration_rotation(const std::filesystem::path& file, std::string_view key);

}  // namespace rilo::detail
