// Motion prediction from past poses (III-B).
#pragma once

#include <cstdint>

#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Weight w_r of the newest increment: bounded, and growing with σ_th. w_e = 1 − w_r.
double recent_weight(double sigma_th_m, const MotionPredictionConfig& config);

/// Body velocity [rad/s; m/s] that the last poses of `past` predict: zero with fewer than two poses, the last
/// increment's with two, the weighted mean on se(3) of the last two increments' with three. Increments are divided by
/// their own time steps, so that dropped sweeps do not bend the prediction.
Vector6d predict_velocity(const Trajectory& past, double sigma_th_m, const MotionPredictionConfig& config);

/// T_pred at `stamp_ns`: the last pose moved on with predict_velocity. Identity when `past` is empty.
SE3 predict_pose(const Trajectory& past, std::int64_t stamp_ns, double sigma_th_m,
                 const MotionPredictionConfig& config);

}  // namespace rilo
