// A sweep going into the local map.
#include <cstdint>
#include <memory>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"

namespace rilo::bench {
namespace {

void count_points(benchmark::State& state) {
  state.SetItemsProcessed(static_cast<std::int64_t>(scene().map_compensated.size()) * state.iterations());
}

/// The next sweep of the drive, as in steady state: some voxels are new, most are known.
void insert_next(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    auto map = std::make_unique<LocalMap>(scene().map);
    state.ResumeTiming();
    map->insert(scene().map_compensated, scene().state.T_odom_lidar);
    state.PauseTiming();
    map.reset();
    state.ResumeTiming();
  }
  count_points(state);
}
BENCHMARK(insert_next)->Unit(benchmark::kMicrosecond);

/// The same sweep again and again, as when the vehicle stands: all voxels are known, and full.
void insert_again(benchmark::State& state) {
  LocalMap map = scene().map;
  for (int i = 0; i < 30; ++i) {
    map.insert(scene().map_compensated, scene().state.T_odom_lidar);
  }
  for (auto _ : state) {
    map.insert(scene().map_compensated, scene().state.T_odom_lidar);
  }
  count_points(state);
}
BENCHMARK(insert_again)->Unit(benchmark::kMicrosecond);

/// The first sweep: nothing is known.
void insert_first(benchmark::State& state) {
  for (auto _ : state) {
    LocalMap map(OdometryConfig().map);
    map.set_scene_range(scene().last.scene_range_m);
    map.insert(scene().map_compensated, scene().state.T_odom_lidar);
    benchmark::DoNotOptimize(&map);
  }
  count_points(state);
}
BENCHMARK(insert_first)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rilo::bench
