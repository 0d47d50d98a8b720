// The columns of a .bin record, as given.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/cloud_columns.hpp"

namespace rilo::detail {

/// See SourceOptions::bin_fields. @throws std::invalid_argument when `text` makes no sense.
std::vector<Field> parse_bin_fields(const std::string& text);

/// For bin_fields "auto": x,y,z,intensity, or with a ring behind when the sizes of the files fit nothing else and the
/// fifth column has numbers of beams, or when they are named as nuScenes does (NAME.pcd.bin).
std::string guess_bin_fields(const std::vector<std::filesystem::path>& files);

}  // namespace rilo::detail
