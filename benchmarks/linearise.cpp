// One iteration of the fine registration, and all of it.
#include <cstdint>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "bench_scene.hpp"

namespace rilo::bench {
namespace {

constexpr double kSigmaM = 0.1;

void linearise_all(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const OdometryConfig config;
  const auto stride = static_cast<std::size_t>(state.range(0));
  const TimedCloud& source = scene().last.source;
  std::size_t inliers = 0;
  for (auto _ : state) {
    const NormalEquations sums = linearise(source, scene().map, scene().state, kSigmaM, config.icp, stride);
    inliers = sums.count;
    benchmark::DoNotOptimize(inliers);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(source.size() / stride) * state.iterations());
  state.counters["inliers"] = static_cast<double>(inliers);
}
BENCHMARK(linearise_all)->ArgName("stride")->Arg(1)->Arg(4)->Unit(benchmark::kMicrosecond);

/// From 0.1 m and 0.01 rad off.
void register_from_aside(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const OdometryConfig config;
  Vector12d off = Vector12d::Zero();
  off[2] = 0.01;
  off[3] = 0.1;
  const MotionState start = perturbed(scene().state, off);
  int iterations = 0;
  for (auto _ : state) {
    const IcpResult result = adaptive_icp(scene().last.source, scene().map, start, {}, kSigmaM, config.icp);
    iterations = result.iterations;
    benchmark::DoNotOptimize(iterations);
  }
  state.counters["icp_iterations"] = iterations;
}
BENCHMARK(register_from_aside)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rilo::bench
