#include "io/folders/kitti_oxts.hpp"

#include <array>
#include <cmath>
#include <system_error>

#include "geometry/degrees.hpp"
#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/folders/kitti_calibration.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/folders/sweep_files.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr double kEarthRadiusM = 6378137;
constexpr double kMostLatitudeDeg = 89;  // the projection's height grows without bound towards the poles

// The first six of the numbers of a file.
struct Oxts {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;
  double roll_rad = 0;
  double pitch_rad = 0;
  double yaw_rad = 0;
};

Oxts read_oxts(const fs::path& file) {
  const FileBytes bytes = read_file(file);
  const auto line = LineScanner(bytes.view()).next();
  WordScanner words(line.value_or(""));
  std::array<double, 6> values{};
  for (double& value : values) {
    const auto word = words.next();
    const auto number = word ? parse_double(*word) : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      throw IoError({file, word ? at_line(1, words.column()) : at_line(1),
                     word ? in_quotes(*word) : "the end of the line",
                     "latitude, longitude, altitude, roll, pitch and yaw as numbers", "Unpack the drive again"});
    }
    value = *number;
  }
  if (std::abs(values[0]) > kMostLatitudeDeg) {
    throw IoError(
        {file, at_line(1), "latitude " + std::to_string(values[0]), "-89 to 89 degrees", "Unpack the drive again"});
  }
  return {values[0], values[1], values[2], values[3], values[4], values[5]};
}

// East, north, up; `scale` is the cosine of the first latitude.
SE3 mercator_pose(const Oxts& oxts, double scale) {
  SE3 T = SE3::Identity();
  T.linear() = (Eigen::AngleAxisd(oxts.yaw_rad, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(oxts.pitch_rad, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(oxts.roll_rad, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  const double half_colatitude = (90 + oxts.latitude_deg) * kRadPerDeg / 2;
  T.translation() << scale * kEarthRadiusM * oxts.longitude_deg * kRadPerDeg,
      scale * kEarthRadiusM * std::log(std::tan(half_colatitude)), oxts.altitude_m;
  return T;
}

SE3 lidar_from_imu(const fs::path& drive) {
  constexpr const char* kName = "calib_imu_to_velo.txt";
  std::error_code error;
  const fs::path day = fs::canonical(drive, error).parent_path();
  const fs::path file = path_exists(drive / kName) ? drive / kName : day / kName;
  if (!path_exists(file)) {
    throw IoError({drive / "oxts", "", "poses of the GPS/IMU unit and no calib_imu_to_velo.txt",
                   std::string("that file in ") + drive.string() + " or " + day.string(), kCalibrationRemedy});
  }
  return renormalised(calibration_transform(file));
}

// Drives as "_extract" have the unit's own 100 Hz: their numbers are not those of the sweeps.
void check_synchronised(const fs::path& drive, const fs::path& data) {
  const fs::path stamps = drive / "velodyne_points" / "timestamps.txt";
  if (!path_exists(stamps)) return;
  const std::size_t files = files_with(data, {".txt"}).size();
  const std::size_t sweeps = read_dates(stamps).size();
  if (files == sweeps) return;
  throw IoError({data, "", counted(files, "file"),
                 "one for each of the " + counted(sweeps, "sweep") + " in " + stamps.string(),
                 "Use the synchronised form of the drive (its name ends in _sync)"});
}

}  // namespace

std::optional<GroundTruth> kitti_raw_truth(const fs::path& drive) {
  const fs::path data = drive / "oxts" / "data";
  const fs::path sweeps = drive / "velodyne_points" / "data";
  if (!is_folder(sweeps) || !is_folder(data)) return std::nullopt;
  check_synchronised(drive, data);
  const SE3 T_imu_lidar = lidar_from_imu(drive).inverse();
  GroundTruth truth{{}, drive / "oxts", "stamp", {}};
  std::optional<double> scale;
  SE3 T_first_world;
  for (const fs::path& sweep : find_sweep_files(sweeps).files) {
    const Oxts oxts = read_oxts((data / sweep.stem()).concat(".txt"));
    if (!scale) scale = std::cos(oxts.latitude_deg * kRadPerDeg);
    const SE3 T_world_lidar = mercator_pose(oxts, *scale) * T_imu_lidar;
    if (truth.T_world_lidar.empty()) T_first_world = T_world_lidar.inverse();
    truth.T_world_lidar.push_back(T_first_world * T_world_lidar);
  }
  return truth;
}

}  // namespace rilo::detail
