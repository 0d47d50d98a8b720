// Looking up the map's plane at a point.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"

namespace rilo::bench {
namespace {

/// Time of one look-up: points of the last sweep at their true place. `lift_m` takes them off every surface.
void find(benchmark::State& state, double lift_m) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : scene().source_compensated) {
    points.emplace_back(scene().state.T_odom_lidar * p.cast<double>() + Eigen::Vector3d(0, 0, lift_m));
  }
  MapPlane plane;
  std::size_t i = 0;
  std::int64_t hits = 0;
  for (auto _ : state) {
    hits += scene().map.find(points[i], plane) ? 1 : 0;
    benchmark::DoNotOptimize(plane);
    i = i + 1 < points.size() ? i + 1 : 0;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(state.iterations());
}

void find_hit(benchmark::State& state) { find(state, 0); }
BENCHMARK(find_hit);

/// Every level is asked in vain.
void find_miss(benchmark::State& state) { find(state, 50); }
BENCHMARK(find_miss);

}  // namespace
}  // namespace rilo::bench
