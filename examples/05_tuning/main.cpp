// The default configuration and one's own on the same data: tuning DATA key=value...
// `rilo config --dump` lists all keys. Example: tuning drive map.voxel_m=1 icp.max_iterations=10
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "rilo/config/config_file.hpp"
#include "rilo/session/session.hpp"

namespace {

rilo::SessionResult run(const char* name, const char* data, const rilo::OdometryConfig& config) {
  rilo::SessionOptions options;
  options.config = config;
  rilo::SessionResult result = rilo::run_recording(data, options);
  std::size_t ok = 0;
  double total_ms = 0;
  for (const rilo::SweepResult& sweep : result.results) {
    ok += sweep.status == rilo::OdometryStatus::kOk ? 1 : 0;
    total_ms += sweep.stats.times.total_ms;
  }
  std::printf("%s: %.1f ms per sweep, %zu of %zu ok\n", name, total_ms / static_cast<double>(result.results.size()), ok,
              result.results.size());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: tuning DATA key=value...\n", stderr);
    return 2;
  }
  try {
    const rilo::OdometryConfig defaults;  // rilo::load_config("my.yaml") reads one from a file
    const rilo::OdometryConfig tuned = rilo::with_overrides(defaults, std::vector<std::string>(argv + 2, argv + argc));
    const rilo::SessionResult one = run("default", argv[1], defaults);
    const rilo::SessionResult other = run("tuned", argv[1], tuned);
    const double apart =
        (one.results.back().T_odom_lidar.translation() - other.results.back().T_odom_lidar.translation()).norm();
    std::printf("ends %.3f m apart\n", apart);
    return 0;
  } catch (const std::exception& error) {  // ConfigError names the key, its range and the nearest known one
    std::fprintf(stderr, "tuning: %s\n", error.what());
    return 1;
  }
}
