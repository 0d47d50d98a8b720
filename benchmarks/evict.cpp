// Dropping what lies far behind.
#include <memory>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"

namespace rilo::bench {
namespace {

constexpr int kRound = 32;  // calls until every voxel has been examined

/// One call with nothing to drop: its slice is examined.
void evict_nothing(benchmark::State& state) {
  LocalMap map = scene().map;
  const Eigen::Vector3d centre = scene().state.T_odom_lidar.translation();
  for (int i = 0; i < kRound; ++i) {
    map.evict(centre);
  }
  for (auto _ : state) {
    map.evict(centre);
  }
  state.counters["voxels"] = static_cast<double>(map.size());
}
BENCHMARK(evict_nothing)->Unit(benchmark::kMicrosecond);

/// A full round that drops about half the map: the vehicle has moved on by the map's radius.
void evict_half(benchmark::State& state) {
  const double radius_m = OdometryConfig().map.radius_m;
  const Eigen::Vector3d centre = scene().state.T_odom_lidar * Eigen::Vector3d(radius_m, 0, 0);
  std::size_t left = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto map = std::make_unique<LocalMap>(scene().map);
    state.ResumeTiming();
    for (int i = 0; i < kRound; ++i) {
      map->evict(centre);
    }
    state.PauseTiming();
    left = map->size();
    map.reset();
    state.ResumeTiming();
  }
  state.counters["voxels"] = static_cast<double>(scene().map.size());
  state.counters["left"] = static_cast<double>(left);
}
BENCHMARK(evict_half)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rilo::bench
