#include "io/folders/scan_listing.hpp"

#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/median.hpp"
#include "io/file_bytes.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

double rate_of_drive(const fs::path& meta_file, double otherwise_s) {
  const FileBytes bytes = read_file(meta_file);
  const auto meta = nlohmann::json::parse(bytes.view(), nullptr, false);
  if (!meta.is_object()) {
    throw IoError({meta_file, "", "text that is not a JSON object", "the drive simulator's description",
                   "Write the drive again, or remove meta.json to read it as a KITTI sequence"});
  }
  const auto rate = meta.find("rate_hz");
  if (rate == meta.end()) return otherwise_s;
  constexpr double kLargestRate = 1000;
  const double rate_hz = rate->is_number() ? rate->get<double>() : 0;
  if (!(rate_hz > 0 && rate_hz <= kLargestRate)) {
    throw IoError(
        {meta_file, "", "rate_hz " + in_quotes(rate->dump()), "a number above 0, at most 1000", "Correct rate_hz"});
  }
  return 1 / rate_hz;
}

void add_point_times(ScanListing& listing, const fs::path& folder) {
  listing.fraction_files = find_sweep_files(folder).files;
  if (listing.fraction_files.size() != listing.files.size()) {
    throw IoError({folder, "", std::to_string(listing.fraction_files.size()) + " files of point times",
                   "one for each of the " + std::to_string(listing.files.size()) + " sweeps in velodyne",
                   "Copy or write the drive again, or set point_times (--point-times) to none or azimuth"});
  }
  for (std::size_t i = 0; i < listing.files.size(); ++i) {
    if (listing.fraction_files[i].stem() == listing.files[i].stem()) continue;
    throw IoError({listing.fraction_files[i], "", "point times beside sweep " + listing.files[i].filename().string(),
                   "files of the same names", "Copy or write the drive again"});
  }
}

// A file that may be of something else: it is used when it fits, and named when not.
std::vector<std::int64_t> stamps_that_fit(const fs::path& file, ScanListing& listing) {
  std::string why;
  try {
    std::vector<std::int64_t> stamps = read_stamp_list(file);
    if (stamps.size() == listing.files.size()) return stamps;
    why = std::to_string(stamps.size()) + " stamps for " + std::to_string(listing.files.size()) + " sweeps";
  } catch (const IoError& error) {
    why = error.what();
  }
  listing.info.warnings.push_back("stamps not taken from " + file.string() + ": " + why);
  return {};
}

// folder/times.txt must fit. Without it: the names of the sweeps, then timestamps.txt in the folder, then times.txt and
// timestamps.txt above it, when the sweeps themselves lie in it.
std::vector<std::int64_t> find_stamps(const fs::path& folder, bool look_above, ScanListing& listing) {
  const fs::path stamp_file = folder / "times.txt";
  if (path_exists(stamp_file)) {
    std::vector<std::int64_t> stamps = read_stamps(stamp_file);
    check_stamp_count(stamp_file, stamps.size(), listing.files.size());
    listing.stamp_file = stamp_file;
    return stamps;
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

void make_a_drive_of(ScanListing& listing, const fs::path& folder, const SourceOptions& options) {
  const fs::path meta = folder / "meta.json";
  listing.info.kind = "drive simulator";
  if (path_exists(meta)) {
    listing.info.period_s = rate_of_drive(meta, listing.info.period_s);
    listing.period_known = true;
  }
  const fs::path times = folder / "times_pt";
  if (!path_exists(times)) return;
  if (options.point_times == PointTimes::kAuto) add_point_times(listing, times);
  // Sweeps begin straight behind, and are stamped there.
  listing.forward_after_s = listing.info.period_s / 2;
}

}  // namespace

std::optional<double> mean_period_s(const std::vector<std::int64_t>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) {
      steps.push_back(static_cast<double>(stamp_difference(stamps[i], stamps[i - 1])) * 1e-9);
    }
  }
  if (steps.empty()) return std::nullopt;
  const double median = upper_median(std::span(steps));
  std::erase_if(steps, [median](double step) { return std::abs(step - median) > 0.5 * median; });
  return std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(steps.size());
}

void note_odd_period(const std::string& of, SourceInfo& info) {
  // 100 Hz and more are parts of a sweep, 1 Hz are sweeps that were thinned out: both are left a factor of two.
  constexpr double kShortest = 0.005;
  constexpr double kLongest = 2;
  if (info.period_s >= kShortest && info.period_s <= kLongest) return;
  info.warnings.push_back(
      fmt::format("the stamps of {} say that there is a sweep every {:g} s: they seem to be in another unit than "
                  "seconds; correct them, or take them away to assume a rate (--rate)",
                  of, info.period_s));
}

void note_bad_sweep(const IoError& error, SourceInfo& info) {
  constexpr std::size_t kMostMessages = 20;
  if (info.bad_sweeps++ < kMostMessages) info.warnings.push_back(std::string("skipped: ") + error.what());
}

void add_bad_sweep_count(SourceInfo& info) {
  if (info.bad_sweeps == 0) return;
  info.warnings.push_back(counted(info.bad_sweeps, "sweep") + " could not be read and " +
                          (info.bad_sweeps == 1 ? "was" : "were") + " skipped");
}

void start_listing(ScanListing& listing, const char* kind, const fs::path& path, SweepFiles found) {
  listing.info.kind = kind;
  listing.info.format = std::move(found.format);
  listing.info.path = path;
  listing.info.sweeps = found.files.size();
  listing.files = std::move(found.files);
}

void set_stamps(ScanListing& listing, std::vector<std::int64_t> stamps, const SourceOptions& options) {
  if (!stamps.empty()) {
    listing.stamps_ns = std::move(stamps);
    if (const auto period_s = mean_period_s(listing.stamps_ns)) {
      listing.info.period_s = *period_s;
      listing.period_known = true;
      note_odd_period(listing.stamp_file.empty() ? "the names of the files" : listing.stamp_file.string(),
                      listing.info);
    } else {
      listing.info.period_s = 1 / options.assumed_rate_hz;
    }
    return;
  }
  listing.info.period_s = 1 / options.assumed_rate_hz;
  listing.info.stamps_assumed = true;
  const double period_ns = 1e9 / options.assumed_rate_hz;
  for (const std::int64_t place : places_from_names(listing.files)) {
    listing.stamps_ns.push_back(std::llround(static_cast<double>(place) * period_ns));
  }
}

void check_stamp_count(const fs::path& stamp_file, std::size_t stamps, std::size_t files) {
  if (stamps == files) return;
  throw IoError({stamp_file, "", std::to_string(stamps) + " stamps",
                 "one for each of the " + std::to_string(files) + " sweeps",
                 "Complete the data, or move times.txt away to assume a constant rate"});
}

ScanListing list_sequence(const fs::path& folder, const SourceOptions& options) {
  ScanListing listing;
  start_listing(listing, "kitti", folder, find_sweep_files(folder / "velodyne"));
  set_stamps(listing, find_stamps(folder, false, listing), options);
  if (path_exists(folder / "times_pt") || path_exists(folder / "meta.json")) make_a_drive_of(listing, folder, options);
  const fs::path calibration = folder / "calib.txt";
  if (path_exists(calibration)) {
    listing.info.T_cam_lidar = read_kitti_calibration(calibration);
    if (!listing.info.T_cam_lidar) listing.info.warnings.push_back("calib.txt has no line Tr: no camera frame");
  }
  return listing;
}

ScanListing list_plain_folder(const fs::path& folder, const SourceOptions& options) {
  ScanListing listing;
  start_listing(listing, "folder", folder, find_sweep_files(folder));
  set_stamps(listing, find_stamps(folder, true, listing), options);
  return listing;
}

ScanListing list_single_file(const fs::path& file, const SourceOptions& options) {
  ScanListing listing;
  const std::string format = sweep_format(file);
  if (format.empty()) {
    throw IoError({file, "", "a file with the extension " + in_quotes(file.extension().string()), ".bin, .pcd or .ply",
                   "Give a sweep or a folder of sweeps"});
  }
  start_listing(listing, "file", file, {format, {file}});
  set_stamps(listing, stamps_from_names(listing.files), options);
  return listing;
}

}  // namespace rilo::detail
