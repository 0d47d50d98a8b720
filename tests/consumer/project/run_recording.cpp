// A user's program: a folder of sweeps, opened and run in two passes.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "rilo/session/session.hpp"

namespace {

void write_bin(const std::filesystem::path& file, const rilo::Sweep& sweep) {
  std::ofstream stream(file, std::ios::binary);
  for (const Eigen::Vector3f& p : sweep.points) {
    const float record[] = {p.x(), p.y(), p.z(), 0.0F};
    stream.write(reinterpret_cast<const char*>(record), sizeof record);
  }
}

}  // namespace

int run_recording_of_a_room(const rilo::Sweep& first, const rilo::Sweep& second) {
  const std::filesystem::path folder = "sweeps";
  std::filesystem::create_directory(folder);
  write_bin(folder / "0.bin", first);
  write_bin(folder / "1.bin", second);
  const rilo::SessionResult run = rilo::run_recording(folder);
  const Eigen::Vector3d moved = run.trajectory().back().T_odom_lidar.translation();
  std::printf("moved %.3f %.3f %.3f m in %zu sweeps\n", moved.x(), moved.y(), moved.z(), run.results.size());
  return (moved - Eigen::Vector3d(0.5, 0.0, 0.0)).norm() < 0.1 && run.results.size() == 2 ? 0 : 1;
}
