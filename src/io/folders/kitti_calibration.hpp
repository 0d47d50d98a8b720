// The calibration files of KITTI raw, which lie beside the drives of a day.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo::detail {

/// The numbers behind `key` ("R:"); other words are skipped. Empty when there is no such line.
std::vector<double> calibration_row(const std::filesystem::path& file, std::string_view key);

/// The transform of `R:` (row by row) and `T:` (m), its rotation as the file has it. Nothing when a row is missing or
/// has another number of entries.
std::optional<SE3> calibration_transform(const std::filesystem::path& file);

}  // namespace rilo::detail
