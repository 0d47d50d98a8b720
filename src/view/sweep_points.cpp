#include "sweep_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud/deskew.hpp"

namespace rilo::view {

namespace {

constexpr double kPlaneVoxelM = 0.6;
constexpr double kPlaneRadiusM = 80.0;
constexpr float kNoPlane = std::numeric_limits<float>::quiet_NaN();

// Indices of every n-th point within range and with a finite time.
std::vector<std::size_t> chosen(const ViewSweep& view, std::size_t max_points, double min_range_m, double max_range_m,
                                std::size_t phase) {
  const Sweep& sweep = view.sweep;
  const std::size_t n = sweep.points.size();
  const std::size_t stride = std::max<std::size_t>(1, (n + max_points - 1) / std::max<std::size_t>(1, max_points));
  const auto least = static_cast<float>(min_range_m * min_range_m);
  const auto most = static_cast<float>(max_range_m * max_range_m);
  std::vector<std::size_t> indices;
  indices.reserve(n / stride + 1);
  for (std::size_t i = phase % stride; i < n; i += stride) {
    const float squared = sweep.points[i].squaredNorm();
    const bool timed = sweep.times_s.empty() || std::isfinite(sweep.times_s[i]);
    if (squared >= least && squared <= most && timed) indices.push_back(i);  // NaN is neither
  }
  return indices;
}

std::vector<float> column(const std::vector<float>& values, const std::vector<std::size_t>& indices) {
  std::vector<float> out;
  if (values.empty()) return out;
  out.reserve(indices.size());
  for (const std::size_t i : indices) out.push_back(values[i]);
  return out;
}

}  // namespace

SweepPoints sample_sweep(const ViewSweep& view, std::size_t max_points, double min_range_m, double max_range_m,
                         std::size_t phase) {
  const std::vector<std::size_t> indices = chosen(view, max_points, min_range_m, max_range_m, phase);
  SweepPoints out;
  out.points.reserve(indices.size());
  for (const std::size_t i : indices) out.points.push_back(view.sweep.points[i]);
  out.intensities = column(view.sweep.intensities, indices);
  out.times_s = column(view.sweep.times_s, indices);
  if (out.times_s.empty()) return out;
  // The pose is that of the middle of the sweep.
  const auto [first, last] = std::minmax_element(out.times_s.begin(), out.times_s.end());
  const float middle = 0.5F * (*first + *last);
  for (float& t : out.times_s) t -= middle;
  const SweepMotion motion({view.result.twist, view.result.acceleration},
                           {out.times_s[static_cast<std::size_t>(first - out.times_s.begin())],
                            out.times_s[static_cast<std::size_t>(last - out.times_s.begin())]});
  for (std::size_t i = 0; i < out.points.size(); ++i) out.points[i] = motion.compensate(out.points[i], out.times_s[i]);
  return out;
}

ResidualMap::ResidualMap() : grid_(kPlaneVoxelM, {6, 24, 0.1, 0.1 * kPlaneVoxelM}) {}

void ResidualMap::measure(const SE3& T_odom_lidar, SweepPoints& sweep) const {
  sweep.residuals_m.assign(sweep.points.size(), kNoPlane);
  MapPlane plane;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3d p = T_odom_lidar * sweep.points[i].cast<double>();
    if (grid_.find(p, plane)) sweep.residuals_m[i] = static_cast<float>(std::abs(plane.normal.dot(p - plane.point)));
  }
}

void ResidualMap::add(const SE3& T_odom_lidar, const SweepPoints& sweep) {
  for (const Eigen::Vector3f& p : sweep.points) {
    if (static_cast<double>(p.norm()) < kPlaneRadiusM) grid_.insert(T_odom_lidar * p.cast<double>());
  }
  grid_.refit();
  grid_.evict(T_odom_lidar.translation(), kPlaneRadiusM);
}

}  // namespace rilo::view
