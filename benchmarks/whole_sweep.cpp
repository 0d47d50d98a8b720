// Odometry::register_sweep in steady state.
#include <memory>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::bench {
namespace {

constexpr std::size_t kWarmUp = 20;

/// The drive from its beginning up to its steady state.
std::unique_ptr<Odometry> warmed_up(const OdometryConfig& config) {
  auto odometry = std::make_unique<Odometry>(config);
  for (std::size_t i = 0; i < kWarmUp; ++i) {
    odometry->register_sweep(drive()[i].sweep);
  }
  return odometry;
}

void register_sweep(benchmark::State& state) {
  OdometryConfig config;
  config.threads = static_cast<int>(state.range(0));
  auto odometry = warmed_up(config);
  std::size_t next = kWarmUp;
  double not_ok = 0;
  for (auto _ : state) {
    if (next == drive().size()) {
      state.PauseTiming();
      odometry = warmed_up(config);
      next = kWarmUp;
      state.ResumeTiming();
    }
    const SweepResult result = odometry->register_sweep(drive()[next++].sweep);
    not_ok += result.status == OdometryStatus::kOk ? 0 : 1;
  }
  state.counters["not_ok"] = not_ok;
  state.counters["points"] = static_cast<double>(drive().back().sweep.points.size());
}
// So many that the drive is gone through four times.
BENCHMARK(register_sweep)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(80)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rilo::bench
