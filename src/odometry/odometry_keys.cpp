// The table of all keys: one line each. A key that is added here is checked, loaded, dumped and documented;
// `rilo config --dump > config/default.yaml` and docs/configuration.md renew the files (the tests compare them).
#include "rilo/odometry/odometry_keys.hpp"

namespace rilo {
namespace {

void add_preprocess(KeyVisitor& keys, PreprocessConfig& c) {
  keys.section("preprocess", "Range crop, downsampling and motion compensation");
  keys.real("min_range_m", c.min_range_m, 0, 1000, "m", "nearer points are dropped (the vehicle itself)");
  keys.real("max_range_m", c.max_range_m, 1, 1000, "m", "farther points are dropped; at least min_range_m");
  keys.boolean("deskew", c.deskew, "use per-point times when the sweep has them");
  keys.integer("source_points", c.source_points, 100, 1000000, "",
               "aim for the size of the source cloud; its voxel adapts");
  keys.real("min_voxel_m", c.min_voxel_m, 0.01, 10, "m", "least voxel of the source cloud");
  keys.real("max_voxel_m", c.max_voxel_m, 0.01, 10, "m", "largest voxel of the source cloud; at least min_voxel_m");
  keys.real("map_voxel_ratio", c.map_voxel_ratio, 0.1, 1, "", "voxel of the cloud for the map, in source voxels");
}

void add_coarse(KeyVisitor& keys, CoarseRegistrationConfig& c) {
  keys.section("coarse", "Density-filtered distribution-to-distribution registration (III-A)");
  keys.boolean("enabled", c.enabled, "false: ablation A, the prediction is the initial pose");
  keys.boolean("always", c.always, "true: on every sweep as in the paper; false: only when the prediction is in doubt");
  keys.real("voxel_m", c.voxel_m, 0.05, 10, "m", "voxel of its clouds");
  keys.integer("max_points", c.max_points, 10, 1000000, "", "at most that many points a cloud");
  keys.real("density_radius_m", c.density_radius_m, 0.05, 20, "m", "r: neighbours within it count as density (eq. 1)");
  keys.real("density_percentile", c.density_percentile, 0, 99, "%", "alpha: share of the least dense points dropped");
  keys.integer("neighbours", c.neighbours, 4, 100, "", "k of the covariances (eq. 2)");
  keys.real("sigma", c.sigma, 0.001, 1000, "", "sigma of the weight (eq. 6), in units of the Mahalanobis distance");
  keys.real("damping", c.damping, 0, 1000, "", "lambda (eq. 9), relative to the largest diagonal element");
  keys.integer("max_iterations", c.max_iterations, 1, 1000, "", "iterations from one start");
  keys.real("max_correspondence_m", c.max_correspondence_m, 0.01, 100, "m", "farther pairs are not valid");
  keys.real("noise_first_m", c.noise_first_m, 0.001, 10, "m",
            "standard deviation added to the covariances at first ...");
  keys.real("noise_last_m", c.noise_last_m, 0.001, 10, "m", "... and in the last iteration");
}

void add_prediction(KeyVisitor& keys, MotionPredictionConfig& prediction, MotionPriorConfig& prior) {
  keys.section("prediction", "Motion prediction from up to three past poses (III-B)");
  keys.boolean("enabled", prediction.enabled, "false: the last pose is the prediction");
  keys.real("recent_half_sigma_m", prediction.recent_half_sigma_m, 0.001, 100, "m",
            "sigma_th at which the newest increment weighs 3/4");

  keys.section("prior", "Prior of the registration from the motion so far (white noise on acceleration)");
  keys.boolean("enabled", prior.enabled, "false: the sweep alone decides, as in the paper");
  keys.real("acceleration_m_s2", prior.acceleration_m_s2, 0.01, 1000, "m/s²",
            "usual change of velocity within 0.1 s, per second");
  keys.real("angular_acceleration_rad_s2", prior.angular_acceleration_rad_s2, 0.01, 1000, "rad/s²",
            "the same of the turn rate");
  keys.real("unseen_share", prior.unseen_share, 0.001, 1, "",
            "share of both that counts after a degenerate sweep: what is not seen is taken to go on as it did");
}

void add_initial_pose(KeyVisitor& keys, InitialPoseConfig& c) {
  using Rule = InitialPoseRule;
  keys.section("initial_pose", "Choice of the initial pose between prediction and coarse result (III-B)");
  keys.choice<Rule>("rule", c.rule, {{"fixed_tau", Rule::kFixedTau}, {"map_score", Rule::kMapScore}},
                    "fixed_tau: the paper's, coarse result if within tau; map_score: which explains the map better");
  keys.real("tau_m", c.tau_m, 0, 100, "m", "tau of the paper's rule");
  keys.real("score_sigma_m", c.score_sigma_m, 0.001, 10, "m", "tolerance of the map score");
  keys.integer("score_points", c.score_points, 10, 1000000, "", "points that the map score looks at");
  keys.real("alarm", c.alarm, 0, 1, "",
            "the prediction is in doubt when its score is below this share of the usual score");
  keys.real("margin", c.margin, 0, 1, "", "by what share the coarse result's score must beat the prediction's");
  keys.boolean("restarts", c.restarts, "in doubt, start the coarse stage also from poses found by a search on the map");
  keys.real("search_shift_m", c.search_shift_m, 0, 50, "m", "half width of that search along x and y");
  keys.real("search_yaw_rad", c.search_yaw_rad, 0, 3.2, "rad", "half width of that search in yaw");
}

void add_threshold(KeyVisitor& keys, AdaptiveThresholdConfig& c) {
  keys.section("threshold", "Adaptive threshold sigma_th (III-C)");
  keys.real("initial_m", c.initial_m, 0.001, 100, "m", "sigma_th before any error is known");
  keys.real("floor_m", c.floor_m, 0.001, 100, "m", "sigma_th is never below");
  keys.real("ceiling_m", c.ceiling_m, 0.001, 100, "m", "sigma_th is never above; at least floor_m");
  keys.real("decay", c.decay, 0.001, 1000, "", "sigma_decay of the motion weight gamma");
  keys.real("rotation_scale_m", c.rotation_scale_m, 0, 100, "m",
            "sigma_max: largest share of the rotation in the error");
  keys.real("rotation_gain", c.rotation_gain, 0, 1000, "1/rad", "beta of tanh(beta theta)");
  keys.real("forgetting", c.forgetting, 0, 1, "", "weight of the past per sweep; 1: the paper's mean over all sweeps");
}

void add_icp(KeyVisitor& keys, AdaptiveIcpConfig& c) {
  keys.section("icp", "Point-to-plane registration of the source cloud to the local map (III-D)");
  keys.boolean("adaptive", c.adaptive,
               "false: ablation B, unit weights within fixed_gate_m instead of weights from sigma_th");
  keys.real("fixed_gate_m", c.fixed_gate_m, 0.001, 100, "m",
            "residuals beyond it are no correspondences when adaptive is off");
  keys.real("gate", c.gate, 0.1, 100, "", "residuals beyond gate * sigma_th are no correspondences");
  keys.integer("max_iterations", c.max_iterations, 1, 1000, "", "iterations of one registration");
  keys.integer("coarse_stride", c.coarse_stride, 1, 100, "", "every n-th point until it converges, then all points");
  keys.real("damping", c.damping, 0, 1000, "", "lambda, relative to the largest diagonal element");
  keys.real("rotation_epsilon_rad", c.rotation_epsilon_rad, 0, 1, "rad", "converged when an update turns less ...");
  keys.real("translation_epsilon_m", c.translation_epsilon_m, 0, 1, "m", "... and moves less");
  keys.boolean("refine_motion", c.refine_motion, "estimate the velocity during the sweep together with the pose");
  keys.real("noise_m", c.noise_m, 0.0001, 10, "m", "least standard deviation of a residual");
  keys.real("scatter_noise_m", c.scatter_noise_m, 0.0001, 10, "m",
            "sigma of the weight sigma²/(sigma² + variance) of points that meet no plane");
  keys.real("independent_share", c.independent_share, 1e-6, 1, "", "share of the residuals that count as independent");
  keys.real("weak_direction", c.weak_direction, 0, 1, "",
            "relative eigenvalue at which half of a direction is the prior's; 0: off");
}

void add_map(KeyVisitor& keys, LocalMapConfig& c) {
  keys.section("map", "Local voxel map");
  keys.real("voxel_m", c.voxel_m, 0.01, 10, "m", "smallest voxel; every level above doubles it");
  keys.integer("levels", c.levels, 1, 10, "", "number of voxel sizes");
  keys.real("scene_voxels", c.scene_voxels, 1, 10000, "",
            "the finest level in use has the voxel nearest to scene range / this");
  keys.real("radius_m", c.radius_m, 1, 10000, "m", "voxels farther from the sensor are evicted");
  keys.integer("min_points", c.min_points, 3, 1000000, "", "a voxel with fewer points has no plane");
  keys.integer("max_points", c.max_points, 3, 1000000, "",
               "a smallest voxel is full with so many, each level above with half as many more; at least min_points");
  keys.real("max_planarity", c.max_planarity, 0, 1, "", "largest smallest-to-middle eigenvalue ratio of a plane");
  keys.real("min_extent", c.min_extent, 0, 1, "voxels", "smallest middle standard deviation of a plane");
  keys.real("range_noise_m", c.range_noise_m, 0, 1, "m", "sigma_r: standard deviation of a point along its ray");
  keys.real("angle_noise_rad", c.angle_noise_rad, 0, 0.1, "rad",
            "sigma_a: standard deviation of the direction of a point; 0: normals count as exact");
  keys.real("scatter_voxel_m", c.scatter_voxel_m, 0, 10, "m",
            "smallest voxel whose points count as a Gaussian where they are no plane; 0: off");
}

void add_elevation(KeyVisitor& keys, ElevationOffsetConfig& c) {
  keys.section("elevation", "Constant error of the sensor's elevation angles, found from the sweeps alone");
  keys.boolean("enabled", c.enabled, "estimate it, and correct it once it is certain");
  keys.real("initial_deg", c.initial_deg, -10, 10, "deg",
            "what was found before: added to the elevation angles from the first sweep on, followed when certain");
  keys.real("significance", c.significance, 0, 1000, "",
            "certain when so many standard deviations from 0 or initial_deg; 1000: never, estimate only");
  keys.real("least_deg", c.least_deg, 0, 10, "deg", "smaller errors are not corrected");
  keys.real("step_deg", c.step_deg, 0.0001, 1, "deg", "the correction moves by at most this from sweep to sweep");
}

void add_beams(KeyVisitor& keys, BeamCalibrationConfig& c) {
  keys.section("beams", "Errors of the angles of single beams against their neighbours, found from the sweeps alone");
  keys.boolean("enabled", c.enabled, "find and correct them");
  keys.real("gain", c.gain, 0.0001, 1, "", "share of what a sweep shows that is corrected at once");
}

void add_health(KeyVisitor& keys, HealthConfig& c) {
  keys.section("health", "When a pose is called degenerate, poorly supported or lost");
  keys.real("lost_share", c.lost_share, 0, 1, "", "lost when the map score falls below this share of the usual one");
  keys.real("least_score", c.least_score, 0, 1, "", "lost below it, whatever is usual");
  keys.real("few_inlier_ratio", c.few_inlier_ratio, 0, 1, "",
            "fewer correspondences than this share of the source are few");
  keys.real("degenerate_ratio", c.degenerate_ratio, 0, 1, "",
            "a relative eigenvalue below it: a direction is not constrained");
  keys.integer("restart_after", c.restart_after, 1, 1000000, "sweeps",
               "lost for so long, a new map starts at the predicted pose");
}

void add_bounds(KeyVisitor& keys, MotionBoundsConfig& c) {
  keys.section("bounds", "How a sensor can move at most; a pose that says more is lost until a second one agrees");
  keys.real("max_speed_m_s", c.max_speed_m_s, 0.01, 100000, "m/s", "fastest vehicle");
  keys.real("max_acceleration_m_s2", c.max_acceleration_m_s2, 0.01, 100000, "m/s²",
            "a braking car has 10, an arm that jerks the sensor up to 30");
  keys.real("max_turn_rate_rad_s", c.max_turn_rate_rad_s, 0.01, 1000, "rad/s", "fastest turn");
  keys.real("max_angular_acceleration_rad_s2", c.max_angular_acceleration_rad_s2, 0.01, 100000, "rad/s²",
            "a wrist has up to 50");
}

void add_budget(KeyVisitor& keys, TimeBudgetConfig& c) {
  keys.section("budget", "Less work a sweep when time is short; results then depend on the machine");
  keys.real("sweep_ms", c.sweep_ms, 0, 1e6, "ms",
            "how long a sweep may take, reading excluded: beyond it fewer points, no coarse stage; 0: no limit");
}

}  // namespace

void visit_keys(OdometryConfig& c, KeyVisitor& keys) {
  keys.integer("threads", c.threads, 0, 1024, "", "0: as many as the machine has; the results do not depend on it");
  add_preprocess(keys, c.preprocess);
  add_coarse(keys, c.coarse);
  add_prediction(keys, c.prediction, c.prior);
  add_initial_pose(keys, c.initial_pose);
  add_threshold(keys, c.threshold);
  add_icp(keys, c.icp);
  add_map(keys, c.map);
  add_elevation(keys, c.elevation);
  add_beams(keys, c.beams);
  add_health(keys, c.health);
  add_bounds(keys, c.bounds);
  add_budget(keys, c.budget);
}

}  // namespace rilo
