// From a raw sweep to the clouds the pipeline works on.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"
#include "cloud/voxel_mean.hpp"
#include "cloud/voxel_sampler.hpp"

namespace rilo::bench {
namespace {

constexpr double kVoxelM = 0.3;

void count_points(benchmark::State& state, std::size_t points) {
  state.SetItemsProcessed(static_cast<std::int64_t>(points) * state.iterations());
}

void prepare(benchmark::State& state) {
  const Sweep& sweep = drive().back().sweep;
  Preprocessor preprocessor(OdometryConfig().preprocess);
  preprocessor.prepare(sweep);  // finds the scale
  for (auto _ : state) {
    benchmark::DoNotOptimize(&preprocessor.prepare(sweep));
  }
  count_points(state, sweep.points.size());
}
BENCHMARK(prepare)->Unit(benchmark::kMicrosecond);

void voxel_mean(benchmark::State& state) {
  const Sweep& sweep = drive().back().sweep;
  const TimedCloud cloud{sweep.points, sweep.times_s};
  VoxelMean mean;
  TimedCloud out;
  for (auto _ : state) {
    mean.average(cloud, kVoxelM, out);
    benchmark::DoNotOptimize(out.points.data());
  }
  count_points(state, cloud.size());
}
BENCHMARK(voxel_mean)->Unit(benchmark::kMicrosecond);

void voxel_sampler(benchmark::State& state) {
  const Sweep& sweep = drive().back().sweep;
  VoxelSampler sampler;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sampler.sample(sweep.points, kVoxelM).data());
  }
  count_points(state, sweep.points.size());
}
BENCHMARK(voxel_sampler)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rilo::bench
