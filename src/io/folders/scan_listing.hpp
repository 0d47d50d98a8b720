// The files of a data folder, in order, with their stamps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// What the files are to become a ScanSource.
struct ScanListing {
  SourceInfo info;
  std::vector<std::filesystem::path> files;
  std::vector<std::int64_t> stamps_ns;                ///< as long as files
  std::filesystem::path stamp_file;                   ///< where they are from; empty: the names, or none
  std::vector<std::filesystem::path> fraction_files;  ///< a drive simulator's times_pt; empty, or as long as files
  std::size_t column_points = 0;                      ///< points per column, fired together; 0: unknown
  bool period_known = false;                          ///< info.period_s comes from stamps or meta.json
  double forward_after_s = 0;                         ///< from the stamp to the time when the sensor faces forward
};

/// Sweeps of these files, one file each.
std::unique_ptr<ScanSource> open_files(ScanListing listing, const SourceOptions& options);

/// KITTI sequence or drive simulator's folder: it has a subfolder velodyne.
ScanListing list_sequence(const std::filesystem::path& folder, const SourceOptions& options);

/// Folder of .bin, .pcd or .ply, or one such file.
ScanListing list_plain_folder(const std::filesystem::path& folder, const SourceOptions& options);
ScanListing list_single_file(const std::filesystem::path& file, const SourceOptions& options);

/// A drive of KITTI raw: it has velodyne_points/data. MulRan's sequences have sensor_data/Ouster.
bool is_kitti_raw(const std::filesystem::path& folder);
ScanListing list_kitti_raw(const std::filesystem::path& folder, const SourceOptions& options);
bool is_mulran(const std::filesystem::path& folder);
ScanListing list_mulran(const std::filesystem::path& folder, const SourceOptions& options);

/// A data folder of any of these kinds. @throws IoError when it is none: a recording, nothing.
ScanListing list_folder(const std::filesystem::path& folder, const SourceOptions& options);

/// Where in a data folder of one of these kinds the sweeps lie; the folder itself for others.
std::filesystem::path sweep_folder(const std::filesystem::path& data);

/// Sweep files of a folder, all of one kind, in natural order, or, where their names are decimal seconds, in that of
/// time.
struct SweepFiles {
  std::string format;  ///< bin, pcd, ply
  std::vector<std::filesystem::path> files;
};
/// Fills in what is known of a listing from its files.
void start_listing(ScanListing& listing, const char* kind, const std::filesystem::path& path, SweepFiles found);

/// @throws IoError when there is none (with `look_below`, it names a subfolder that has some), or more than one kind.
SweepFiles find_sweep_files(const std::filesystem::path& folder, bool look_below = true);

/// bin, pcd or ply by the extension, whatever its case; empty for other files.
std::string sweep_format(const std::filesystem::path& file);

/// Numbers inside the names count as numbers: 2.bin comes before 10.bin.
void sort_naturally(std::vector<std::filesystem::path>& files);

/// What lies in `folder` with one of the extensions (lower case), in natural order, hidden files left out; nothing
/// where it cannot be listed.
std::vector<std::filesystem::path> files_with(const std::filesystem::path& folder,
                                              std::initializer_list<std::string_view> extensions);

/// Stamps of files named after them: 19 digits are ns, 16 are µs, decimals are seconds. Empty unless all files say so
/// and the stamps increase.
std::vector<std::int64_t> stamps_from_names(const std::vector<std::filesystem::path>& files);

/// Places in the recording of files that are numbered, from 0: 7.pcd, 8.pcd, 11.pcd have 0, 1, 4, and 0.bin, 5.bin,
/// 15.bin 0, 1, 3. One after the other unless the names differ in an increasing number of at most nine digits alone, of
/// which a quarter is there.
std::vector<std::int64_t> places_from_names(const std::vector<std::filesystem::path>& files);

/// Mean of the steps that move forward, in s, without gaps and bursts, which are off by more than half of the median
/// step: the median alone is a whole number of 10 ms where stamps are rounded to that. Nothing when there are none.
std::optional<double> mean_period_s(const std::vector<std::int64_t>& stamps);

/// Warns of a period that no LiDAR has: its stamps, `of` something, are in another unit.
void note_odd_period(const std::string& of, SourceInfo& info);

/// Counts a skipped sweep (OnBadSweep::kSkip); the first ones are warnings of their own.
void note_bad_sweep(const IoError& error, SourceInfo& info);
/// The warning with the number of those.
void add_bad_sweep_count(SourceInfo& info);

/// Sets stamps and period from `stamps`, or from the assumed rate when there are none; adds the warnings.
void set_stamps(ScanListing& listing, std::vector<std::int64_t> stamps, const SourceOptions& options);

/// @throws IoError unless there are as many stamps as files.
void check_stamp_count(const std::filesystem::path& stamp_file, std::size_t stamps, std::size_t files);

}  // namespace rilo::detail
