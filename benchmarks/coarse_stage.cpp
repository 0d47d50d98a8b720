// Coarse registration: making its clouds, and aligning them.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "bench_scene.hpp"
#include "cloud/thinning.hpp"
#include "cloud/voxel_sampler.hpp"
#include "registration/coarse_registration.hpp"

namespace rilo::bench {
namespace {

/// Downsampled as the initial-pose stage does.
std::vector<Eigen::Vector3f> coarse_points(const std::vector<Eigen::Vector3f>& points,
                                           const CoarseRegistrationConfig& config) {
  VoxelSampler sampler;
  std::vector<Eigen::Vector3f> sampled;
  for (const std::uint32_t i : sampler.sample(points, config.voxel_m)) {
    sampled.push_back(points[i]);
  }
  return evenly_picked(sampled, static_cast<std::size_t>(config.max_points));
}

void distribution_cloud(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CoarseRegistrationConfig config;
  const auto points = coarse_points(scene().source_compensated, config);
  for (auto _ : state) {
    const DistributionCloud cloud = make_distribution_cloud(points, config);
    benchmark::DoNotOptimize(cloud.covariances.data());
  }
  state.counters["points"] = static_cast<double>(points.size());
}
BENCHMARK(distribution_cloud)->Unit(benchmark::kMicrosecond);

void align_from(benchmark::State& state, const SE3& start) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CoarseRegistrationConfig config;
  const auto source = make_distribution_cloud(coarse_points(scene().source_compensated, config), config);
  const auto target = make_distribution_cloud(coarse_points(scene().before_compensated, config), config);
  CoarseResult result;
  for (auto _ : state) {
    result = coarse_registration(source, target, start, config);
    benchmark::DoNotOptimize(result.iterations);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["error_m"] = (scene().T_before_last.inverse() * result.T_target_source).translation().norm();
}

/// From the true motion, as a good prediction would give.
void align_from_truth(benchmark::State& state) { align_from(state, scene().T_before_last); }
BENCHMARK(align_from_truth)->Unit(benchmark::kMicrosecond);

/// From no motion at all: a metre off.
void align_from_rest(benchmark::State& state) { align_from(state, SE3::Identity()); }
BENCHMARK(align_from_rest)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rilo::bench
