// The files of a data folder, in order, with their stamps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "io/folders/sweep_files.hpp"
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

/// One .bin, .pcd or .ply file. @throws IoError when it is none.
ScanListing list_single_file(const std::filesystem::path& file, const SourceOptions& options);

/// A folder of these, or one in the layout of a data set. @throws IoError when it is none: a recording, nothing.
ScanListing list_folder(const std::filesystem::path& folder, const SourceOptions& options);

/// Where in a data folder of one of these kinds the sweeps lie; the folder itself for others.
std::filesystem::path sweep_folder(const std::filesystem::path& data);

/// Stamps of sweeps that have none, one every `period_s`.
void assume_stamps(ScanListing& listing, double period_s);

/// What is known of a listing from its files.
ScanListing listing_of(const char* kind, const std::filesystem::path& path, SweepFiles found);

/// Stamps that lie beside the sweeps: folder/times.txt, which must fit. Without it: the names of the sweeps, then
/// timestamps.txt in the folder, then, with `look_above`, times.txt and timestamps.txt above it. Empty: there are none.
/// @throws IoError
std::vector<std::int64_t> find_stamps(const std::filesystem::path& folder, bool look_above, ScanListing& listing);

/// Sets stamps and period from `stamps`, or from the assumed rate when there are none; adds the warnings.
void set_stamps(ScanListing& listing, std::vector<std::int64_t> stamps, const SourceOptions& options);

}  // namespace rilo::detail
