// The shortest program that uses the library: sweeps in, poses out.
#include <cstdio>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

int main() {
  rilo::DriveConfig drive;  // any source of sweeps will do: points, optional times, a stamp
  drive.sensor = rilo::SensorKind::kVlp16;
  drive.sweeps = 10;
  drive.start_s = 5.0;
  const rilo::DriveSimulator simulator(drive);

  rilo::Odometry odometry(rilo::OdometryConfig{});
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const rilo::SweepResult result = odometry.register_sweep(simulator.sweep(i).sweep);
    const Eigen::Vector3d p = result.T_odom_lidar.translation();
    std::printf("sweep %zu: %s  x %.3f  y %.3f  z %.3f m\n", i, to_string(result.status).data(), p.x(), p.y(), p.z());
  }
  return odometry.trajectory().size() == drive.sweeps ? 0 : 1;
}
