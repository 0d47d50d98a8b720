// Neighbour search in one cloud.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "bench_scene.hpp"
#include "cloud/point_grid.hpp"

namespace rilo::bench {
namespace {

constexpr double kCellM = 2.0;
constexpr double kReachM = 3.0;

void build(benchmark::State& state) {
  const auto& points = scene().before_compensated;
  PointGrid grid(kCellM);
  for (auto _ : state) {
    grid.build(points);
    benchmark::DoNotOptimize(grid.points().data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(points.size()) * state.iterations());
}
BENCHMARK(build)->Unit(benchmark::kMicrosecond);

/// Time of one query: points of the last sweep, at their place in the sweep before.
template <typename Query>
void query_each(benchmark::State& state, const Query& query) {
  PointGrid grid(kCellM);
  grid.build(scene().before_compensated);
  std::vector<Eigen::Vector3f> moved;
  for (const Eigen::Vector3f& p : scene().source_compensated) {
    moved.push_back((scene().T_before_last * p.cast<double>()).cast<float>());
  }
  std::size_t i = 0;
  for (auto _ : state) {
    query(grid, moved[i]);
    i = i + 1 < moved.size() ? i + 1 : 0;
  }
  state.SetItemsProcessed(state.iterations());
}

void nearest_one(benchmark::State& state) {
  query_each(state, [](const PointGrid& grid, const Eigen::Vector3f& p) {
    Neighbour found;
    benchmark::DoNotOptimize(grid.nearest(p, kReachM, found));
    benchmark::DoNotOptimize(found);
  });
}
BENCHMARK(nearest_one);

void nearest_ten(benchmark::State& state) {
  std::vector<Neighbour> found;
  query_each(state, [&found](const PointGrid& grid, const Eigen::Vector3f& p) {
    grid.nearest(p, 10, kReachM, found);
    benchmark::DoNotOptimize(found.data());
  });
}
BENCHMARK(nearest_ten);

void count_within(benchmark::State& state) {
  query_each(state, [](const PointGrid& grid, const Eigen::Vector3f& p) {
    benchmark::DoNotOptimize(grid.count_within(p, kCellM));
  });
}
BENCHMARK(count_within);

}  // namespace
}  // namespace rilo::bench
