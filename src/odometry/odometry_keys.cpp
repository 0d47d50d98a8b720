// The table of all keys: one entry each. A key that is added here is checked, loaded, dumped and documented;
// `rilo config --dump > config/default.yaml` and docs/configuration.md renew the files (the tests compare them).
// An entry with a source is an expert key: (III-A …) are sections of the paper, "experiment" names a row of
// docs/experiments.md, "not tuned" is a plausible value that no experiment has moved.
#include "rilo/odometry/odometry_keys.hpp"

namespace rilo {
namespace {

constexpr std::string_view kNotTuned = "not tuned";

void add_preprocess(KeyVisitor& keys, PreprocessConfig& c) {
  keys.section("preprocess", "Range crop, downsampling and motion compensation");
  keys.real({"min_range_m", "m", "nearer points are dropped (the vehicle itself)"}, c.min_range_m, 0, 1000);
  keys.real({"max_range_m", "m", "farther points are dropped; at least min_range_m"}, c.max_range_m, 1, 1000);
  keys.boolean({"deskew", "", "use per-point times when the sweep has them"}, c.deskew);
  keys.integer(
      {"source_points", "", "target size of the source cloud S; its voxel adapts. Fewer points cost less time"},
      c.source_points, 100, 1000000);
  keys.real({"min_voxel_m", "m", "smallest voxel of the source cloud", kNotTuned}, c.min_voxel_m, 0.01, 10);
  keys.real({"max_voxel_m", "m", "largest voxel of the source cloud; at least min_voxel_m", kNotTuned}, c.max_voxel_m,
            0.01, 10);
  keys.real({"map_voxel_ratio", "", "voxel size of the map cloud relative to that of the source cloud",
             "experiment: preprocess.map_voxel_ratio 0.6 to 0.8"},
            c.map_voxel_ratio, 0.1, 1);
  keys.real(
      {"most_isolated", "", "where more of the returns within 30 m are isolated, these are dropped as flakes; 1: never",
       "experiment: isolated returns dropped"},
      c.most_isolated, 0, 1);
}

void add_coarse(KeyVisitor& keys, CoarseRegistrationConfig& c) {
  keys.section("coarse", "Density-filtered distribution-to-distribution registration (III-A)");
  keys.boolean({"enabled", "", "false: ablation A, the prediction is the initial pose", "III-A"}, c.enabled);
  keys.boolean({"always", "", "true: on every sweep as in the paper; false: only when the prediction is in doubt",
                "III-A: true"},
               c.always);
  keys.real({"voxel_m", "m", "voxel size of the coarse clouds", kNotTuned}, c.voxel_m, 0.05, 10);
  keys.integer({"max_points", "", "largest number of points of a coarse cloud", "experiment: 2000 to 1000 points"},
               c.max_points, 10, 1000000);
  keys.real({"density_radius_m", "m", "r: radius of the neighbours that count as density",
             "III-A, eq. 1, without a value; not tuned"},
            c.density_radius_m, 0.05, 20);
  keys.real({"density_percentile", "%", "alpha: share of the least dense points dropped", "III-A: 5"},
            c.density_percentile, 0, 99);
  keys.integer({"neighbours", "", "k: neighbours of the covariances", "III-A, eq. 2, without a value; not tuned"},
               c.neighbours, 4, 100);
  keys.real({"sigma", "", "sigma of the weight, in units of the Mahalanobis distance", "III-A, eq. 6: 1 in the table"},
            c.sigma, 0.001, 1000);
  keys.real(
      {"damping", "", "lambda, relative to the largest diagonal element", "III-A, eq. 9, without a value; not tuned"},
      c.damping, 0, 1000);
  keys.integer({"max_iterations", "", "iterations from one start", kNotTuned}, c.max_iterations, 1, 1000);
  keys.real({"max_correspondence_m", "m", "pairs farther apart are not valid", kNotTuned}, c.max_correspondence_m, 0.01,
            100);
  keys.real(
      {"noise_first_m", "m", "s: standard deviation added to the covariances in the first iteration ...", kNotTuned},
      c.noise_first_m, 0.001, 10);
  keys.real({"noise_last_m", "m", "... and from the middle of the iterations on", kNotTuned}, c.noise_last_m, 0.001,
            10);
}

void add_prediction(KeyVisitor& keys, MotionPredictionConfig& prediction, MotionPriorConfig& prior) {
  keys.section("prediction", "Motion prediction from up to three past poses (III-B)");
  keys.boolean({"enabled", "", "false: the last pose is the prediction", "III-B"}, prediction.enabled);
  keys.real({"recent_half_sigma_m", "m", "sigma_th at which the weight w_r of the newest increment is 3/4",
             "III-B, without a value; not tuned"},
            prediction.recent_half_sigma_m, 0.001, 100);

  keys.section("prior", "Prior of the registration from the motion so far (white noise on acceleration)");
  keys.boolean({"enabled", "", "false: the sweep alone decides, as in the paper", "experiment: open field"},
               prior.enabled);
  keys.boolean({"learn", "", "angular acceleration at least the configured one, else as the drive so far shows it",
                "experiment: angular acceleration from the drive"},
               prior.learn);
  keys.real({"acceleration_m_s2", "m/s²", "standard deviation of the change of velocity in 0.1 s, per second",
             "experiment: planes that know their noise"},
            prior.acceleration_m_s2, 0.01, 1000);
  keys.real({"angular_acceleration_rad_s2", "rad/s²", "the same of the turn rate", kNotTuned},
            prior.angular_acceleration_rad_s2, 0.01, 1000);
  keys.real({"unseen_share", "", "factor on both after a degenerate sweep (stiffer constant-velocity prior)",
             "experiment: accelerations after degenerate sweeps"},
            prior.unseen_share, 0.001, 1);
}

void add_initial_pose(KeyVisitor& keys, InitialPoseConfig& c) {
  using Rule = InitialPoseRule;
  keys.section("initial_pose", "Choice of the initial pose between prediction and coarse result (III-B)");
  keys.choice<Rule>({"rule", "",
                     "fixed_tau: the paper's, coarse result if within tau; map_score: the one that explains the map "
                     "better",
                     "III-B: fixed_tau"},
                    c.rule, {{"fixed_tau", Rule::kFixedTau}, {"map_score", Rule::kMapScore}});
  keys.real({"tau_m", "m", "tau of the paper's rule", "III-B, without a value; not tuned"}, c.tau_m, 0, 100);
  keys.real({"score_sigma_m", "m", "tolerance of the map score", kNotTuned}, c.score_sigma_m, 0.001, 10);
  keys.integer({"score_points", "", "points that the map score uses", kNotTuned}, c.score_points, 10, 1000000);
  keys.real({"alarm", "", "the prediction is in doubt when its score is below this share of the usual score",
             "experiment: alarm 0.8 to 0.7"},
            c.alarm, 0, 1);
  keys.real({"margin", "", "share by which the coarse result's score must exceed the prediction's", kNotTuned},
            c.margin, 0, 1);
  keys.boolean({"restarts", "", "in doubt, start the coarse stage also from poses found by a search on the map",
                "experiment: coarse stage with restarts"},
               c.restarts);
  keys.real({"search_shift_m", "m", "radius of that search in x and y", kNotTuned}, c.search_shift_m, 0, 50);
  keys.real({"search_yaw_rad", "rad", "half width of that search in yaw", kNotTuned}, c.search_yaw_rad, 0, 3.2);
}

void add_threshold(KeyVisitor& keys, AdaptiveThresholdConfig& c) {
  keys.section("threshold", "Adaptive threshold sigma_th (III-C)");
  keys.real({"initial_m", "m", "sigma_th before any error is known", "III-C, without a value; not tuned"}, c.initial_m,
            0.001, 100);
  keys.real({"floor_m", "m", "lower bound of sigma_th", "experiment: sigma_th at least 3 cm"}, c.floor_m, 0.001, 100);
  keys.real({"ceiling_m", "m", "upper bound of sigma_th; at least floor_m", kNotTuned}, c.ceiling_m, 0.001, 100);
  keys.real(
      {"narrowing", "",
       "once a registration has converged, sigma_th is divided by this until it is floor_m; 1: off, as in the paper",
       "experiment: sigma_th narrows"},
      c.narrowing, 1, 100);
  keys.real({"decay", "", "sigma_decay of the motion weight gamma", "III-C: 1.5"}, c.decay, 0.001, 1000);
  keys.real({"rotation_scale_m", "m", "sigma_max: largest share of the rotation in the error",
             "III-C, without a value; not tuned"},
            c.rotation_scale_m, 0, 100);
  keys.real({"rotation_gain", "1/rad", "beta of tanh(beta theta)", "III-C, without a value; not tuned"},
            c.rotation_gain, 0, 1000);
  keys.real({"forgetting", "", "weight of the past per sweep; 1: mean over all sweeps", "III-C: 1; not tuned"},
            c.forgetting, 0, 1);
}

void add_icp(KeyVisitor& keys, AdaptiveIcpConfig& c) {
  keys.section("icp", "Point-to-plane registration of the source cloud to the local map (III-D)");
  keys.boolean(
      {"adaptive", "", "false: ablation B, unit weights within fixed_gate_m instead of weights from sigma_th", "III-D"},
      c.adaptive);
  keys.real({"fixed_gate_m", "m", "with adaptive off, residuals beyond it are no correspondences", kNotTuned},
            c.fixed_gate_m, 0.001, 100);
  keys.real({"gate", "", "residuals beyond gate * sigma_th are no correspondences", kNotTuned}, c.gate, 0.1, 100);
  keys.integer({"max_iterations", "", "iterations of one registration", "experiment: 30 to 24 iterations"},
               c.max_iterations, 1, 1000);
  keys.integer({"coarse_stride", "", "every n-th point until it converges, then all points", kNotTuned},
               c.coarse_stride, 1, 100);
  keys.real({"damping", "", "lambda, relative to the largest diagonal element", "III-D, without a value; not tuned"},
            c.damping, 0, 1000);
  keys.real({"epsilon", "", "converged when an update is smaller, in standard deviations of pose and velocity",
             "experiment: convergence in standard deviations"},
            c.epsilon, 0, 10);
  keys.boolean({"refine_motion", "", "estimate the velocity during the sweep together with the pose",
                "docs/method.md, adaptive ICP"},
               c.refine_motion);
  keys.real({"noise_m", "m", "least standard deviation of a residual", kNotTuned}, c.noise_m, 0.0001, 10);
  keys.real({"scatter_noise_m", "m", "sigma of the weight sigma²/(sigma² + variance) of points that meet no plane",
             "experiment: weight of what is no plane"},
            c.scatter_noise_m, 0.0001, 10);
  keys.real({"independent_share", "", "share of the residuals that count as independent", "experiment: open field"},
            c.independent_share, 1e-6, 1);
  keys.real({"weak_direction", "", "relative eigenvalue at which half of a direction is left to the prior; 0: off",
             "experiment: weak directions"},
            c.weak_direction, 0, 1);
}

void add_map(KeyVisitor& keys, LocalMapConfig& c) {
  keys.section("map", "Local voxel map");
  keys.real({"voxel_m", "m", "smallest voxel; every level above doubles it"}, c.voxel_m, 0.01, 10);
  keys.real({"radius_m", "m", "voxels farther from the sensor are evicted"}, c.radius_m, 1, 10000);
  keys.integer({"levels", "", "number of voxel sizes", "experiment: map.levels 4 to 6"}, c.levels, 1, 10);
  keys.real({"scene_voxels", "", "the finest level in use has the voxel nearest to scene range / this",
             "experiment: scene range / 24 to / 32"},
            c.scene_voxels, 1, 10000);
  keys.integer({"min_points", "", "a voxel with fewer points has no plane", kNotTuned}, c.min_points, 3, 1000000);
  keys.integer({"max_points", "",
                "a smallest voxel is full with this many, each level above with half as many more; at least min_points",
                "experiment: points a voxel"},
               c.max_points, 3, 1000000);
  keys.real({"max_planarity", "", "largest smallest-to-middle eigenvalue ratio of a plane", kNotTuned}, c.max_planarity,
            0, 1);
  keys.real({"min_extent", "voxels", "smallest middle standard deviation of a plane", kNotTuned}, c.min_extent, 0, 1);
  keys.real(
      {"range_noise_m", "m", "sigma_r: standard deviation of a point along its ray", "experiment: noise along the ray"},
      c.range_noise_m, 0, 1);
  keys.real(
      {"angle_noise_rad", "rad", "sigma_a: standard deviation of the direction of a point; 0: normals count as exact",
       "experiment: reliability of normals"},
      c.angle_noise_rad, 0, 0.1);
  keys.real({"scatter_voxel_m", "m", "smallest voxel whose points count as a Gaussian where they are no plane; 0: off",
             "experiment: no Gaussians"},
            c.scatter_voxel_m, 0, 10);
}

void add_elevation(KeyVisitor& keys, ElevationOffsetConfig& c) {
  keys.section("elevation", "Constant error of the sensor's elevation angles, estimated from the sweeps alone");
  keys.boolean({"enabled", "", "estimate it, and correct it once it is significant"}, c.enabled);
  keys.real({"initial_deg", "deg", "known offset: added to the elevation angles from the first sweep on"},
            c.initial_deg, -10, 10);
  keys.real({"significance", "", "standard deviations from 0 or initial_deg that are significant; 1000: estimate only",
             "experiment: sigma of the elevation with errors of beams"},
            c.significance, 0, 1000);
}

void add_beams(KeyVisitor& keys, BeamCalibrationConfig& c) {
  keys.section("beams", "Angular errors of single beams against their neighbours, estimated from the sweeps alone");
  keys.boolean({"enabled", "", "estimate and correct them"}, c.enabled);
  keys.real({"gain", "", "update gain per sweep", "experiment: gain 0.03 to 0.015"}, c.gain, 0.0001, 1);
}

void add_health(KeyVisitor& keys, HealthConfig& c) {
  keys.section("health", "When a pose is degenerate, poorly supported or lost");
  keys.integer({"restart_after", "sweeps",
                "lost so long, a new map starts; missing sweeps count after three that are not covered"},
               c.restart_after, 1, 1000000);
  keys.real(
      {"lost_share", "", "lost when the map score falls below this share of the usual one", "experiment: 384 pairs"},
      c.lost_share, 0, 1);
  keys.real({"least_score", "", "second and third sweep of a map: lost below it", "experiment: snow"}, c.least_score, 0,
            1);
  keys.real({"degenerate_ratio", "", "a direction with a smaller relative eigenvalue is not constrained",
             "experiment: weak directions"},
            c.degenerate_ratio, 0, 1);
}

void add_bounds(KeyVisitor& keys, MotionBoundsConfig& c) {
  keys.section(
      "bounds",
      "Limits of the sensor's motion; a pose beyond them is lost until a second one agrees, unless it fits as usual");
  keys.real({"max_speed_m_s", "m/s", "speed"}, c.max_speed_m_s, 0.01, 100000);
  keys.real({"max_acceleration_m_s2", "m/s²", "acceleration: a braking car has 10, an arm that jerks the sensor 30"},
            c.max_acceleration_m_s2, 0.01, 100000);
  keys.real({"max_turn_rate_rad_s", "rad/s", "turn rate"}, c.max_turn_rate_rad_s, 0.01, 1000);
  keys.real({"max_angular_acceleration_rad_s2", "rad/s²", "angular acceleration: a wrist has up to 50"},
            c.max_angular_acceleration_rad_s2, 0.01, 100000);
}

void add_budget(KeyVisitor& keys, TimeBudgetConfig& c) {
  keys.section("budget", "Less work per sweep when time is short; results then depend on the machine");
  keys.real({"sweep_ms", "ms",
             "time of a sweep, without reading it, that is kept: with fewer points, a shorter search; 0: no limit"},
            c.sweep_ms, 0, 1e6);
}

}  // namespace

void visit_keys(OdometryConfig& c, KeyVisitor& keys) {
  keys.integer({"threads", "", "0: as many as the machine has; the results do not depend on it"}, c.threads, 0, 1024);
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
