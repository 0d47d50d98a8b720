#include "io/folders/scan_listing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/text.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

// times.txt of the sweeps' own folder: no other data are meant.
std::vector<std::int64_t> stamps_for_all(const fs::path& file, const ScanListing& listing) {
  std::vector<std::int64_t> stamps = read_stamps(file);
  if (stamps.size() == listing.files.size()) return stamps;
  throw IoError({file, "", counted(stamps.size(), "stamp"),
                 "one for each of the " + counted(listing.files.size(), "sweep"),
                 "Complete the data, or move times.txt away to assume a constant rate"});
}

// A file that may be of something else: it is used when it fits, and named when not.
std::vector<std::int64_t> stamps_that_fit(const fs::path& file, ScanListing& listing) {
  std::string why;
  try {
    std::vector<std::int64_t> stamps = read_stamps(file);
    if (stamps.size() == listing.files.size()) return stamps;
    why = counted(stamps.size(), "stamp") + " for " + counted(listing.files.size(), "sweep");
  } catch (const IoError& error) {
    why = error.what();
  }
  listing.info.warnings.push_back("stamps not taken from " + file.string() + ": " + why);
  return {};
}

std::string what_to_do_with(const fs::path& file) {
  constexpr std::array<std::string_view, 8> kArchives{".zip", ".gz", ".tgz", ".tar", ".bz2", ".xz", ".zst", ".7z"};
  const std::string extension = lower_case(file.extension().string());
  if (std::find(kArchives.begin(), kArchives.end(), extension) != kArchives.end()) return "Unpack it first";
  if (extension == ".active") return "The recording was not closed: rosbag reindex, then name it .bag";
  return kOtherFormats;
}

}  // namespace

ScanListing listing_of(const char* kind, const fs::path& path, SweepFiles found) {
  ScanListing listing;
  listing.info.kind = kind;
  listing.info.format = std::move(found.format);
  listing.info.path = path;
  listing.info.sweeps = found.files.size();
  listing.files = std::move(found.files);
  return listing;
}

std::vector<std::int64_t> find_stamps(const fs::path& folder, bool look_above, ScanListing& listing) {
  const fs::path stamp_file = folder / "times.txt";
  if (path_exists(stamp_file)) {
    listing.stamp_file = stamp_file;
    return stamps_for_all(stamp_file, listing);
  }
  if (auto stamps = stamps_from_names(listing.files); !stamps.empty()) return stamps;
  std::vector<fs::path> candidates{folder / "timestamps.txt"};
  std::error_code error;
  const fs::path above = fs::canonical(folder, error).parent_path();
  if (look_above && !error) candidates.insert(candidates.end(), {above / "times.txt", above / "timestamps.txt"});
  for (const fs::path& candidate : candidates) {
    if (!path_exists(candidate)) continue;
    auto stamps = stamps_that_fit(candidate, listing);
    if (stamps.empty()) continue;
    listing.stamp_file = candidate;
    return stamps;
  }
  return {};
}

void assume_stamps(ScanListing& listing, double period_s) {
  listing.info.period_s = period_s;
  listing.info.stamps_assumed = true;
  listing.stamps_ns.clear();
  for (const std::int64_t place : places_from_names(listing.files)) {
    listing.stamps_ns.push_back(std::llround(static_cast<double>(place) * period_s * 1e9));
  }
}

void set_stamps(ScanListing& listing, std::vector<std::int64_t> stamps, const SourceOptions& options) {
  listing.info.period_s = 1 / options.assumed_rate_hz();
  if (!stamps.empty()) {
    listing.stamps_ns = std::move(stamps);
    const auto period_s = mean_period_s(listing.stamps_ns);
    if (!period_s) return;
    listing.info.period_s = *period_s;
    listing.period_known = true;
    note_odd_period(listing.stamp_file.empty() ? "the names of the files" : listing.stamp_file.string(), listing.info);
    return;
  }
  assume_stamps(listing, 1 / options.assumed_rate_hz());
}

ScanListing list_single_file(const fs::path& file, const SourceOptions& options) {
  const std::string format = sweep_format(file);
  if (format.empty()) {
    throw IoError({file, "", "a file with the extension " + in_quotes(file.extension().string()),
                   "a sweep (.bin, .pcd, .ply) or a recording (.bag, .mcap, .db3, .pcap, .pcapng)",
                   what_to_do_with(file)});
  }
  ScanListing listing = listing_of("file", file, {format, {file}});
  set_stamps(listing, stamps_from_names(listing.files), options);
  return listing;
}

}  // namespace rilo::detail
