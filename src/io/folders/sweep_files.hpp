// Which files of a folder are sweeps, and what their names say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace rilo::detail {

/// Sweep files of a folder, all of one kind, in natural order, or, where their names are decimal seconds, in that of
/// time.
struct SweepFiles {
  std::string format;  ///< bin, pcd, ply
  std::vector<std::filesystem::path> files;
};

/// @throws IoError when there is none (with `look_below`, it names a subfolder that has some), or more than one kind.
SweepFiles find_sweep_files(const std::filesystem::path& folder, bool look_below = true);

inline constexpr const char* kOtherFormats =
    "Sweeps in other formats: convert them to .pcd or .ply (CloudCompare, PDAL; the times of the points as a "
    "field \"time\"), or register their points from Python";

/// bin, pcd or ply by the extension, whatever its case; empty for other files.
std::string sweep_format(const std::filesystem::path& file);

/// Stamps of files named after them, alone or among other things: 19 digits are ns, 16 µs, 13 ms, decimals seconds.
/// Empty unless each file has one and they increase.
std::vector<std::int64_t> stamps_from_names(const std::vector<std::filesystem::path>& files);

/// Places in the recording of files that are numbered, from 0: 7.pcd, 8.pcd, 11.pcd have 0, 1, 4, and 0.bin, 5.bin,
/// 15.bin 0, 1, 3. One after the other unless the names differ in an increasing number of at most nine digits alone, of
/// which a quarter is there.
std::vector<std::int64_t> places_from_names(const std::vector<std::filesystem::path>& files);

}  // namespace rilo::detail
