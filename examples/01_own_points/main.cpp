// Own points into the odometry: own_points FOLDER POSES.txt
// FOLDER holds .bin files of float32 x, y, z, intensity, 0.1 s apart. Prints a pose per sweep, writes them in TUM's
// form.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <system_error>
#include <vector>

#include "rilo/odometry/odometry.hpp"

namespace {

rilo::Sweep read_sweep(const std::filesystem::path& file, std::int64_t stamp_ns) {
  rilo::Sweep sweep;
  sweep.stamp_ns = stamp_ns;  // ns of any clock; stamps increase
  std::ifstream stream(file, std::ios::binary);
  std::array<float, 4> record{};
  while (stream.read(reinterpret_cast<char*>(record.data()), sizeof record)) {
    // Metres, sensor frame: x forward, y left, z up.
    sweep.points.emplace_back(record[0], record[1], record[2]);
    // Raw points of a moving sensor also have a time each, seconds from the stamp; compensated ones have none:
    //   sweep.times_s.push_back(seconds);
  }
  return sweep;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: own_points FOLDER POSES.txt\n", stderr);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  std::error_code cannot_be_read;  // then there are no entries
  for (const auto& entry : std::filesystem::directory_iterator(argv[1], cannot_be_read)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  if (files.empty()) {
    std::fprintf(stderr, "own_points: no .bin files in %s\n", argv[1]);
    return 1;
  }
  std::sort(files.begin(), files.end());

  rilo::Odometry odometry(rilo::OdometryConfig{});
  std::int64_t stamp_ns = 0;
  for (const auto& file : files) {
    const rilo::SweepResult result = odometry.register_sweep(read_sweep(file, stamp_ns));
    const Eigen::Vector3d p = result.T_odom_lidar.translation();
    std::printf("%s: %s  x %.3f  y %.3f  z %.3f m\n", file.filename().c_str(), to_string(result.status).data(), p.x(),
                p.y(), p.z());
    stamp_ns += 100'000'000;
  }

  std::ofstream poses(argv[2]);
  poses << std::fixed << std::setprecision(9);  // the usual six digits cannot hold a stamp
  for (const rilo::StampedPose& pose : odometry.trajectory()) {
    const Eigen::Vector3d p = pose.T_odom_lidar.translation();
    const Eigen::Quaterniond q(pose.T_odom_lidar.rotation());
    poses << static_cast<double>(pose.stamp_ns) * 1e-9 << ' ' << p.x() << ' ' << p.y() << ' ' << p.z() << ' ' << q.x()
          << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
  }
  std::printf("%zu poses in %s\n", odometry.trajectory().size(), argv[2]);
  return poses ? 0 : 1;
}
