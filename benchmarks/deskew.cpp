// Motion compensation of the cloud that goes into the map.
#include "cloud/deskew.hpp"

#include <cstdint>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"

namespace rilo::bench {
namespace {

void deskew_map_cloud(benchmark::State& state) {
  const TimedCloud& cloud = scene().last.map_cloud;
  std::vector<Eigen::Vector3f> out;
  for (auto _ : state) {
    deskew(cloud, {scene().state.twist}, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(cloud.size()) * state.iterations());
}
BENCHMARK(deskew_map_cloud)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rilo::bench
