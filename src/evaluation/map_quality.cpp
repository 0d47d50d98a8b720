#include "rilo/evaluation/map_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <nanoflann.hpp>
#include <tbb/task_arena.h>

#include "cloud/fixed_chunks.hpp"
#include "cloud/more_workers.hpp"
#include "cloud/voxel_sampler.hpp"
#include "evaluation/percentile.hpp"

namespace rilo {

namespace {

constexpr double kLeastVariance = 1e-12;   // m²: a micrometre; keeps the logarithm of a perfect plane finite
constexpr double kMaxVoxelsOfRange = 1e6;  // what a voxel key can hold

void check(bool sensible, const std::string& what) {
  if (!sensible) throw std::invalid_argument("map quality: " + what);
}

void check(const MapQualityConfig& c) {
  check(c.sweep_step >= 1, "sweep_step (--sweep-step) must be at least 1");
  check(c.min_sweeps >= 1 && c.min_neighbours >= 4, "min_sweeps must be at least 1, min_neighbours at least 4");
  check(c.window_sweeps >= 2 && (c.window_sweeps - 1) / c.sweep_step + 1 >= c.min_sweeps,
        "window_sweeps (--window) is " + std::to_string(c.window_sweeps) + "; it must be at least " +
            std::to_string(std::max<std::size_t>(2, (c.min_sweeps - 1) * c.sweep_step + 1)) + ", to hold " +
            std::to_string(c.min_sweeps) + " sweeps (min_sweeps), one of every " + std::to_string(c.sweep_step) +
            " (sweep_step, --sweep-step)");
  check(c.radius_m > 0 && std::isfinite(c.radius_m), "radius_m (--radius) must be positive");
  check(c.min_range_m >= 0 && c.max_range_m > c.min_range_m && std::isfinite(c.max_range_m),
        "max_range_m (--max-range) must be larger than min_range_m (--min-range)");
  check(c.voxel_m == 0 || (c.voxel_m > 0 && c.max_range_m < kMaxVoxelsOfRange * c.voxel_m),
        "voxel_m (--voxel) must be 0 or positive, and not less than a millionth of max_range_m (--max-range)");
  check(c.points_per_sweep >= 1 && c.samples_per_window >= 1,
        "points_per_sweep (--points) and samples_per_window (--samples) must be positive");
  check(c.max_planar_ratio > 0, "max_planar_ratio must be positive");
  check(c.threads >= 0, "threads must not be negative");
}

// The map of one window.
struct WindowMap {
  std::vector<Eigen::Vector3d> points;  // relative to the first sweep: odometry coordinates would cost digits
  std::vector<std::uint32_t> sweep_of;
  std::uint32_t sweeps = 0;

  // What nanoflann asks for.
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index](static_cast<Eigen::Index>(axis));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, WindowMap>, WindowMap, 3, std::uint32_t>;

// A result set of nanoflann, which asks for these names: all points within the radius, no distances, no order.
class Ball {
 public:
  using DistanceType = double;
  using IndexType = std::uint32_t;
  explicit Ball(double radius_m) : limit_(std::nextafter(radius_m * radius_m, std::numeric_limits<double>::max())) {}
  bool addPoint(double distance2, std::uint32_t index) {  // NOLINT(readability-identifier-naming)
    if (distance2 < limit_) found_.push_back(index);
    return true;
  }
  double worstDist() const { return limit_; }  // NOLINT(readability-identifier-naming)
  bool full() const { return true; }
  bool empty() const { return found_.empty(); }
  std::size_t size() const { return found_.size(); }
  void sort() {}
  const std::vector<std::uint32_t>& found() const { return found_; }

 private:
  double limit_;
  std::vector<std::uint32_t> found_;
};

struct Place {
  bool counts = false;
  bool planar = false;
  double entropy = 0;
  double plane_rms_m = 0;
};

std::size_t sweeps_among(const WindowMap& map, const std::vector<std::uint32_t>& indices) {
  std::vector<bool> seen(map.sweeps, false);
  std::size_t count = 0;
  for (const std::uint32_t i : indices) {
    count += seen[map.sweep_of[i]] ? 0 : 1;
    seen[map.sweep_of[i]] = true;
  }
  return count;
}

Eigen::Matrix3d covariance(const std::vector<Eigen::Vector3d>& points, const std::vector<std::uint32_t>& indices) {
  const auto n = static_cast<double>(indices.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : indices) mean += points[i];
  mean /= n;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : indices) {
    const Eigen::Vector3d d = points[i] - mean;
    sum += d * d.transpose();
  }
  return sum / (n - 1);
}

Place look_at(const WindowMap& map, const Tree& tree, const Eigen::Vector3d& centre, const MapQualityConfig& config) {
  Ball ball(config.radius_m);
  tree.findNeighbors(ball, centre.data(), {});
  Place place;
  if (ball.size() < config.min_neighbours || sweeps_among(map, ball.found()) < config.min_sweeps) return place;
  // Iterated, not in closed form: of a thin wall the smallest eigenvalue matters to the last digit.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(map.points, ball.found()),
                                                              Eigen::EigenvaluesOnly);
  const Eigen::Array3d values = solver.eigenvalues().array().max(kLeastVariance);
  place.counts = true;
  place.entropy = 0.5 * (2 * std::numbers::pi * std::numbers::e * values).log().sum();
  place.planar = values(0) < config.max_planar_ratio * values(1);
  place.plane_rms_m = std::sqrt(values(0));
  return place;
}

}  // namespace

// Evenly filled, the disc has a standard deviation of half its radius along each axis.
double no_plane_m(const MapQualityConfig& config) { return std::sqrt(config.max_planar_ratio) * config.radius_m / 2; }

MapQualityMeter::MapQualityMeter(const MapQualityConfig& config)
    : config_(config), window_step_(std::max<std::size_t>(1, config.window_sweeps / 2)) {
  check(config_);
}

// Whether sweep `number` is in the map of any window: windows begin at the multiples of window_step_.
bool MapQualityMeter::needed(std::size_t number) const {
  for (std::size_t first = number / window_step_ * window_step_; number - first < config_.window_sweeps;
       first -= window_step_) {
    if ((number - first) % config_.sweep_step == 0) return true;
    if (first == 0) break;
  }
  return false;
}

// Every point of the sweep draws a number, whether it is used or not; those with the smallest are kept, in that order.
// So the choice hardly changes when the poses, and with them the motion compensation, move a point across a limit; and
// the first points are themselves a random choice.
MapQualityMeter::Kept MapQualityMeter::thinned(const std::vector<Eigen::Vector3f>& points,
                                               const SE3& T_odom_lidar) const {
  std::seed_seq seeds{static_cast<std::uint32_t>(config_.seed), static_cast<std::uint32_t>(config_.seed >> 32U),
                      static_cast<std::uint32_t>(sweeps_)};
  std::mt19937_64 random(seeds);
  std::vector<Eigen::Vector3f> usable;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> drawn;
  for (const Eigen::Vector3f& p : points) {
    const std::uint64_t number = random();
    const double range_m = p.cast<double>().norm();
    if (std::isfinite(range_m) && range_m > config_.min_range_m && range_m < config_.max_range_m) {
      drawn.emplace_back(number, static_cast<std::uint32_t>(usable.size()));
      usable.push_back(p);
    }
  }
  if (config_.voxel_m > 0) {
    VoxelSampler sampler;
    const auto numbers = std::exchange(drawn, {});
    for (const std::uint32_t i : sampler.sample(usable, config_.voxel_m)) drawn.push_back(numbers[i]);
  }
  std::sort(drawn.begin(), drawn.end());
  drawn.resize(std::min(drawn.size(), config_.points_per_sweep));
  Kept kept{sweeps_, {}, T_odom_lidar};
  for (const auto& [number, i] : drawn) kept.points.push_back(usable[i].cast<double>());
  return kept;
}

void MapQualityMeter::add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar) {
  if (!T_odom_lidar.matrix().allFinite()) {
    throw std::invalid_argument("map quality: the pose of sweep " + std::to_string(sweeps_) + " is not finite");
  }
  if (needed(sweeps_)) kept_.push_back(thinned(points, T_odom_lidar));
  ++sweeps_;
  if (sweeps_ < config_.window_sweeps || (sweeps_ - config_.window_sweeps) % window_step_ != 0) return;
  const std::size_t first = sweeps_ - config_.window_sweeps;
  measure(first);
  while (!kept_.empty() && kept_.front().number < first + window_step_) kept_.pop_front();
}

void MapQualityMeter::measure(std::size_t first) {
  ++windows_;
  const Kept& reference = kept_.front();  // sweep `first`: what came before was dropped with the window before
  WindowMap map;
  for (const Kept& kept : kept_) {
    if ((kept.number - first) % config_.sweep_step != 0) continue;
    const SE3 T_first_kept = reference.T_odom_lidar.inverse() * kept.T_odom_lidar;
    for (const Eigen::Vector3d& p : kept.points) map.points.emplace_back(T_first_kept * p);
    map.sweep_of.resize(map.points.size(), map.sweeps++);
  }
  if (reference.points.empty()) return;
  const Tree tree(3, map, nanoflann::KDTreeSingleIndexAdaptorParams(32));
  std::vector<Place> places(std::min(reference.points.size(), config_.samples_per_window));
  const MoreWorkers workers(config_.threads);
  tbb::task_arena arena(config_.threads > 0 ? config_.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    for_each_index(places.size(), [&](std::size_t i) { places[i] = look_at(map, tree, map.points[i], config_); });
  });
  samples_ += places.size();
  for (const Place& place : places) {
    if (place.counts) entropies_.push_back(place.entropy);
    if (place.planar) plane_rms_m_.push_back(place.plane_rms_m);
  }
}

MapQuality MapQualityMeter::result() const {
  MapQuality quality;
  quality.sweeps = sweeps_;
  quality.windows = windows_;
  quality.samples = samples_;
  quality.places = entropies_.size();
  quality.plane_rms_m = summarise(plane_rms_m_);
  std::vector<double> sorted = plane_rms_m_;
  std::sort(sorted.begin(), sorted.end());
  quality.plane_rms_p75_m = percentile(sorted, 0.75);
  if (samples_ > 0) {
    const double none_m = no_plane_m(config_);
    double sum = none_m * static_cast<double>(samples_ - sorted.size());
    for (const double rms_m : sorted) sum += std::min(rms_m, none_m);
    quality.bounded_rms_m = sum / static_cast<double>(samples_);
    quality.planar_share = static_cast<double>(sorted.size()) / static_cast<double>(samples_);
  }
  if (!entropies_.empty()) quality.mean_map_entropy = summarise(entropies_).mean;
  return quality;
}

MapQuality map_quality(const std::vector<std::vector<Eigen::Vector3f>>& sweeps, const std::vector<SE3>& T_odom_lidar,
                       const MapQualityConfig& config) {
  check(sweeps.size() == T_odom_lidar.size(), "there must be as many poses as sweeps");
  MapQualityMeter meter(config);
  for (std::size_t i = 0; i < sweeps.size(); ++i) meter.add(sweeps[i], T_odom_lidar[i]);
  return meter.result();
}

}  // namespace rilo
