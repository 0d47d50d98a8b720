#include "rilo/odometry/odometry_config.hpp"

#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace rilo {

namespace {

struct Bound {
  const char* name;
  double value;
  double least;
  double most;
};

void check(std::initializer_list<Bound> bounds) {
  for (const Bound& b : bounds) {
    if (!(b.value >= b.least && b.value <= b.most)) {
      throw std::invalid_argument(std::string("configuration: ") + b.name + " is " + std::to_string(b.value) +
                                  ", expected a number from " + std::to_string(b.least) + " to " +
                                  std::to_string(b.most));
    }
  }
}

}  // namespace

void validate(const OdometryConfig& c) {
  // What would divide by zero, allocate without bound or never end. The configuration file's own ranges are narrower.
  check({
      {"threads", static_cast<double>(c.threads), 0, 1024},
      {"preprocess.min_range_m", c.preprocess.min_range_m, 0, 1e4},
      {"preprocess.max_range_m", c.preprocess.max_range_m, c.preprocess.min_range_m, 1e4},
      {"preprocess.source_points", static_cast<double>(c.preprocess.source_points), 100, 1e7},
      {"preprocess.min_voxel_m", c.preprocess.min_voxel_m, 1e-2, 1e2},
      {"preprocess.max_voxel_m", c.preprocess.max_voxel_m, c.preprocess.min_voxel_m, 1e2},
      {"preprocess.map_voxel_ratio", c.preprocess.map_voxel_ratio, 0.1, 1},
      {"coarse.voxel_m", c.coarse.voxel_m, 1e-2, 1e2},
      {"coarse.max_points", static_cast<double>(c.coarse.max_points), 10, 1e7},
      {"coarse.density_radius_m", c.coarse.density_radius_m, 1e-2, 1e2},
      {"coarse.density_percentile", c.coarse.density_percentile, 0, 99},
      {"coarse.neighbours", static_cast<double>(c.coarse.neighbours), 4, 100},
      {"coarse.sigma", c.coarse.sigma, 1e-3, 1e3},
      {"coarse.max_iterations", static_cast<double>(c.coarse.max_iterations), 1, 1000},
      {"coarse.noise_first_m", c.coarse.noise_first_m, 1e-3, 1e2},
      {"coarse.noise_last_m", c.coarse.noise_last_m, 1e-3, 1e2},
      {"coarse.max_correspondence_m", c.coarse.max_correspondence_m, 1e-2, 1e2},
      {"prior.acceleration_m_s2", c.prior.acceleration_m_s2, 1e-3, 1e4},
      {"prior.angular_acceleration_rad_s2", c.prior.angular_acceleration_rad_s2, 1e-3, 1e4},
      {"prior.unseen_share", c.prior.unseen_share, 1e-4, 1},
      {"initial_pose.score_sigma_m", c.initial_pose.score_sigma_m, 1e-3, 1e2},
      {"initial_pose.score_points", static_cast<double>(c.initial_pose.score_points), 10, 1e6},
      {"initial_pose.search_shift_m", c.initial_pose.search_shift_m, 0, 50},
      {"initial_pose.search_yaw_rad", c.initial_pose.search_yaw_rad, 0, 3.2},
      {"threshold.initial_m", c.threshold.initial_m, 1e-3, 1e2},
      {"threshold.floor_m", c.threshold.floor_m, 1e-3, 1e2},
      {"threshold.ceiling_m", c.threshold.ceiling_m, c.threshold.floor_m, 1e2},
      {"threshold.decay", c.threshold.decay, 1e-3, 1e6},
      {"threshold.forgetting", c.threshold.forgetting, 0, 1},
      {"icp.max_iterations", static_cast<double>(c.icp.max_iterations), 1, 1000},
      {"icp.coarse_stride", static_cast<double>(c.icp.coarse_stride), 1, 100},
      {"icp.rematch_m", c.icp.rematch_m, 0, 10},
      {"icp.noise_m", c.icp.noise_m, 1e-4, 10},
      {"icp.independent_share", c.icp.independent_share, 1e-6, 1},
      {"elevation.initial_deg", c.elevation.initial_deg, -10, 10},
      {"elevation.significance", c.elevation.significance, 0, 1e6},
      {"elevation.least_deg", c.elevation.least_deg, 0, 90},
      {"elevation.step_deg", c.elevation.step_deg, 0, 90},
      {"beams.gain", c.beams.gain, 0, 1},
      {"budget.sweep_ms", c.budget.sweep_ms, 0, 1e6},
      {"map.voxel_m", c.map.voxel_m, 1e-2, 1e2},
      {"map.levels", static_cast<double>(c.map.levels), 1, 10},
      {"map.scene_voxels", c.map.scene_voxels, 1, 1e4},
      {"map.radius_m", c.map.radius_m, 1, 1e5},
      {"map.min_points", static_cast<double>(c.map.min_points), 3, 1e6},
      {"map.max_points", static_cast<double>(c.map.max_points), static_cast<double>(c.map.min_points), 1e6},
  });
}

}  // namespace rilo
