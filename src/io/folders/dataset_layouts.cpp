// Folders as data sets are published: KITTI raw, MulRan.
#include <optional>
#include <string>

#include "io/file_bytes.hpp"
#include "io/folders/kitti_calibration.hpp"
#include "io/folders/scan_listing.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

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

// KITTI's Tr is the rectification times the transform of calib_velo_to_cam.txt; both lie beside the drive's folder.
std::optional<SE3> raw_calibration(const fs::path& day) {
  const fs::path velo = day / "calib_velo_to_cam.txt";
  const fs::path cam = day / "calib_cam_to_cam.txt";
  if (!path_exists(velo) || !path_exists(cam)) return std::nullopt;
  const auto T_unrectified = calibration_transform(velo);
  const auto rectify = calibration_row(cam, "R_rect_00:");
  if (!T_unrectified || rectify.size() != 9) return std::nullopt;
  const Eigen::Matrix3d R_rect = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rectify.data());
  SE3 T_cam_lidar = SE3::Identity();
  T_cam_lidar.linear() = R_rect * T_unrectified->linear();
  T_cam_lidar.translation() = R_rect * T_unrectified->translation();
  return T_cam_lidar;
}

}  // namespace

bool is_kitti_raw(const fs::path& folder) { return path_exists(folder / "velodyne_points" / "data"); }

ScanListing list_kitti_raw(const fs::path& folder, const SourceOptions& options) {
  const fs::path points = folder / "velodyne_points";
  ScanListing listing;
  start_listing(listing, "kitti raw", folder, find_sweep_files(points / "data"));
  const fs::path stamp_file = points / "timestamps.txt";
  listing.stamp_file = stamp_file;
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

ScanListing list_folder(const fs::path& folder, const SourceOptions& options) {
  std::error_code ignored;
  if (fs::is_directory(folder / "velodyne", ignored)) return list_sequence(folder, options);
  if (is_kitti_raw(folder)) return list_kitti_raw(folder, options);
  if (is_mulran(folder)) return list_mulran(folder, options);
  return list_plain_folder(folder, options);
}

fs::path sweep_folder(const fs::path& data) {
  std::error_code ignored;
  for (const char* name : {"velodyne", "velodyne_points/data", "sensor_data/Ouster"}) {
    if (fs::is_directory(data / name, ignored)) return data / name;
  }
  return data;
}

}  // namespace rilo::detail
