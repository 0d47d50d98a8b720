// Folders as data sets are published: KITTI odometry and the drive simulator, KITTI raw, MulRan.
#include <array>
#include <iterator>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "io/file_bytes.hpp"
#include "io/folders/kitti_calibration.hpp"
#include "io/folders/scan_listing.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/text.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

double period_of_drive(const fs::path& meta_file, double otherwise_s) {
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
    throw IoError({folder, "", counted(listing.fraction_files.size(), "file") + " of point times",
                   "one for each of the " + counted(listing.files.size(), "sweep") + " in velodyne",
                   "Copy or write the drive again, or set point_times (--point-times) to none or azimuth"});
  }
  for (std::size_t i = 0; i < listing.files.size(); ++i) {
    if (listing.fraction_files[i].stem() == listing.files[i].stem()) continue;
    throw IoError({listing.fraction_files[i], "", "point times beside sweep " + listing.files[i].filename().string(),
                   "files of the same names", "Copy or write the drive again"});
  }
}

void make_a_drive_of(ScanListing& listing, const fs::path& folder, const SourceOptions& options) {
  const fs::path meta = folder / "meta.json";
  listing.info.kind = "drive simulator";
  if (path_exists(meta)) {
    listing.info.period_s = period_of_drive(meta, listing.info.period_s);
    listing.period_known = true;
  }
  const fs::path times = folder / "times_pt";
  if (!path_exists(times)) return;
  if (options.point_times == PointTimes::kAuto) add_point_times(listing, times);
  // Sweeps begin straight behind, and are stamped there.
  listing.forward_after_s = turn_s(listing.info.period_s) / 2;
}

ScanListing list_sequence(const fs::path& folder, const fs::path& sweeps, const SourceOptions& options) {
  ScanListing listing = listing_of("kitti", folder, find_sweep_files(sweeps));
  set_stamps(listing, find_stamps(folder, false, listing), options);
  if (path_exists(folder / "times_pt") || path_exists(folder / "meta.json")) make_a_drive_of(listing, folder, options);
  const fs::path calibration = folder / "calib.txt";
  if (path_exists(calibration)) {
    listing.info.T_cam_lidar = read_kitti_calibration(calibration);
    if (!listing.info.T_cam_lidar) listing.info.warnings.push_back("calib.txt has no line Tr: no camera frame");
  }
  return listing;
}

// Some drives lack sweeps, but no line: the names are numbers of lines.
std::vector<std::int64_t> stamps_of_numbers(const fs::path& stamp_file, const std::vector<fs::path>& files) {
  const std::vector<std::int64_t> all = read_dates(stamp_file);
  std::vector<std::int64_t> stamps;
  for (const fs::path& file : files) {
    const auto number = parse_unsigned(file.stem().string());
    if (!number || *number >= all.size()) {
      throw IoError({stamp_file, "", counted(all.size(), "stamp"), "one for " + file.filename().string(),
                     "Unpack the drive again"});
    }
    stamps.push_back(all[static_cast<std::size_t>(*number)]);
  }
  return stamps;
}

// KITTI's Tr is the rectification times the transform of calib_velo_to_cam.txt; both lie beside the drive's folder.
std::optional<SE3> raw_calibration(const fs::path& day) {
  const fs::path velo = day / "calib_velo_to_cam.txt";
  const fs::path cam = day / "calib_cam_to_cam.txt";
  if (!path_exists(velo) || !path_exists(cam)) return std::nullopt;
  const SE3 T_unrectified = calibration_transform(velo);
  const Eigen::Matrix3d R_rect = calibration_rotation(cam, "R_rect_00:");
  SE3 T_cam_lidar = SE3::Identity();
  T_cam_lidar.linear() = R_rect * T_unrectified.linear();
  T_cam_lidar.translation() = R_rect * T_unrectified.translation();
  return T_cam_lidar;
}

ScanListing list_kitti_raw(const fs::path& folder, const fs::path& sweeps, const SourceOptions& options) {
  ScanListing listing = listing_of("kitti raw", folder, find_sweep_files(sweeps));
  listing.stamp_file = sweeps.parent_path() / "timestamps.txt";
  set_stamps(listing,
             path_exists(listing.stamp_file) ? stamps_of_numbers(listing.stamp_file, listing.files)
                                             : std::vector<std::int64_t>{},
             options);
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  listing.info.T_cam_lidar = raw_calibration(whole.parent_path());
  return listing;
}

ScanListing list_mulran(const fs::path& folder, const fs::path& sweeps, const SourceOptions& options) {
  constexpr std::size_t kBeams = 64;
  ScanListing listing = listing_of("mulran", folder, find_sweep_files(sweeps));
  set_stamps(listing, stamps_from_names(listing.files), options);
  if (listing.info.format == "bin" && options.point_times == PointTimes::kAuto) listing.column_points = kBeams;
  return listing;
}

struct Layout {
  const char* sweeps;  // where they lie: what the layout is recognised by
  ScanListing (*list)(const fs::path& folder, const fs::path& sweeps, const SourceOptions& options);
};
constexpr std::array<Layout, 3> kLayouts{
    {{"velodyne", list_sequence}, {"velodyne_points/data", list_kitti_raw}, {"sensor_data/Ouster", list_mulran}}};

// None: a plain folder.
const Layout* layout_of(const fs::path& folder) {
  for (const Layout& layout : kLayouts) {
    if (is_folder(folder / layout.sweeps)) return &layout;
  }
  return nullptr;
}

/// The data set whose sweeps `folder` holds, if more of it lies there. Empty: none.
fs::path data_set_around(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  for (const Layout& layout : kLayouts) {
    const fs::path sweeps = layout.sweeps;
    fs::path above = whole;
    for (auto levels = std::distance(sweeps.begin(), sweeps.end()); levels > 0; --levels) above = above.parent_path();
    if (error || above / sweeps != whole) continue;
    for (const char* more : {"calib.txt", "poses.txt", "times_pt", "oxts"}) {
      if (path_exists(above / more)) return above;
    }
  }
  return {};
}

ScanListing list_plain_folder(const fs::path& folder, const SourceOptions& options) {
  ScanListing listing = listing_of("folder", folder, find_sweep_files(folder));
  set_stamps(listing, find_stamps(folder, true, listing), options);
  const fs::path data_set = data_set_around(folder);
  if (!data_set.empty()) {
    listing.info.warnings.push_back("these are the sweeps of " + data_set.string() +
                                    ": give that folder, so that its point times, calibration and ground truth count");
  }
  return listing;
}

}  // namespace

ScanListing list_folder(const fs::path& folder, const SourceOptions& options) {
  const Layout* layout = layout_of(folder);
  return layout != nullptr ? layout->list(folder, folder / layout->sweeps, options)
                           : list_plain_folder(folder, options);
}

fs::path sweep_folder(const fs::path& data) {
  const Layout* layout = layout_of(data);
  return layout != nullptr ? data / layout->sweeps : data;
}

}  // namespace rilo::detail
