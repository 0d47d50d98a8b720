// Folders as data sets are published: KITTI raw, MulRan.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/scan_listing.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_writer.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

// "2011-09-26 13:02:25.951199337", taken as UTC.
std::optional<std::int64_t> parse_date(std::string_view text) {
  constexpr std::size_t kToSeconds = 17;  // "2011-09-26 13:02:"
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  std::int64_t hour = 0;
  std::int64_t minute = 0;
  const std::string start(text.substr(0, kToSeconds));
  const int read = std::sscanf(start.c_str(), "%4d-%2u-%2u %2ld:%2ld:", &year, &month, &day, &hour,  // NOLINT
                               &minute);
  if (read != 5 || text.size() <= kToSeconds) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  const auto seconds = parse_stamp(text.substr(kToSeconds));
  if (!date.ok() || hour < 0 || hour > 23 || minute < 0 || minute > 59 || !seconds || *seconds < 0) return std::nullopt;
  if (*seconds > 61'000'000'000 || year < 1970 || year > 2200) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60'000'000'000 + *seconds;
}

std::vector<std::int64_t> read_dates(const fs::path& file) {
  const FileBytes bytes = read_file(file);
  LineScanner lines(bytes.view());
  std::vector<std::int64_t> stamps;
  while (const auto line = lines.next()) {
    const std::string_view text = trimmed(*line);
    if (text.empty()) continue;
    const auto stamp = parse_date(text);
    if (!stamp) {
      throw IoError({file, at_line(lines.number()), in_quotes(text), "a date as 2011-09-26 13:02:25.951199337",
                     "Unpack the drive again"});
    }
    stamps.push_back(*stamp);
  }
  return stamps;
}

// Some drives lack sweeps, but no line: the names are numbers of lines.
std::vector<std::int64_t> stamps_of_numbers(const fs::path& stamp_file, const std::vector<fs::path>& files) {
  const std::vector<std::int64_t> all = read_dates(stamp_file);
  std::vector<std::int64_t> stamps;
  for (const fs::path& file : files) {
    const auto number = parse_unsigned(file.stem().string());
    if (!number || *number >= all.size()) {
      throw IoError({stamp_file, "", std::to_string(all.size()) + " stamps", "one for " + file.filename().string(),
                     "Unpack the drive again"});
    }
    stamps.push_back(all[static_cast<std::size_t>(*number)]);
  }
  return stamps;
}

// The numbers behind `key` in one of KITTI's calibration files.
std::vector<double> calibration_row(const fs::path& file, std::string_view key) {
  const FileBytes bytes = read_file(file);
  LineScanner lines(bytes.view());
  std::vector<double> numbers;
  while (const auto line = lines.next()) {
    if (!line->starts_with(key)) continue;
    for (const std::string_view word : words_of(line->substr(key.size()))) {
      const auto number = parse_double(word);
      if (number) numbers.push_back(*number);
    }
    return numbers;
  }
  return numbers;
}

// KITTI's Tr is the rectification times the transform of calib_velo_to_cam.txt; both lie beside the drive's folder.
std::optional<SE3> raw_calibration(const fs::path& day) {
  const fs::path velo = day / "calib_velo_to_cam.txt";
  const fs::path cam = day / "calib_cam_to_cam.txt";
  if (!path_exists(velo) || !path_exists(cam)) return std::nullopt;
  const auto r = calibration_row(velo, "R:");
  const auto t = calibration_row(velo, "T:");
  const auto rectify = calibration_row(cam, "R_rect_00:");
  if (r.size() != 9 || t.size() != 3 || rectify.size() != 9) return std::nullopt;
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  SE3 T_cam_lidar = SE3::Identity();
  T_cam_lidar.linear() = Eigen::Map<const RowMajor>(rectify.data()) * Eigen::Map<const RowMajor>(r.data());
  T_cam_lidar.translation() = Eigen::Map<const RowMajor>(rectify.data()) * Eigen::Map<const Eigen::Vector3d>(t.data());
  return T_cam_lidar;
}

}  // namespace

bool is_kitti_raw(const fs::path& folder) { return path_exists(folder / "velodyne_points" / "data"); }

ScanListing list_kitti_raw(const fs::path& folder, const SourceOptions& options) {
  const fs::path points = folder / "velodyne_points";
  ScanListing listing;
  start_listing(listing, "kitti raw", folder, find_sweep_files(points / "data"));
  const fs::path stamp_file = points / "timestamps.txt";
  set_stamps(listing,
             path_exists(stamp_file) ? stamps_of_numbers(stamp_file, listing.files) : std::vector<std::int64_t>{},
             options);
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  listing.info.T_cam_lidar = raw_calibration(whole.parent_path());
  return listing;
}

bool is_mulran(const fs::path& folder) { return path_exists(folder / "sensor_data" / "Ouster"); }

ScanListing list_mulran(const fs::path& folder, const SourceOptions& options) {
  constexpr std::size_t kBeams = 64;
  ScanListing listing;
  start_listing(listing, "mulran", folder, find_sweep_files(folder / "sensor_data" / "Ouster"));
  set_stamps(listing, stamps_from_names(listing.files), options);
  if (listing.info.format == "bin" && options.point_times == PointTimes::kAuto) listing.column_points = kBeams;
  return listing;
}

}  // namespace rilo::detail
