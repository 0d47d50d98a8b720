#include "odometry/adaptive_threshold.hpp"

#include <algorithm>
#include <cmath>

namespace rilo {

namespace {
// Failures double the threshold; this bounds the growth and the time it takes to come back.
constexpr double kMaxWidening = 64.0;
}  // namespace

double model_deviation_m(const SE3& T_init, const SE3& T_new, const AdaptiveThresholdConfig& config) {
  const SE3 D = T_init.inverse() * T_new;  // D_model
  return config.rotation_scale_m * std::tanh(config.rotation_gain * rotation_angle_rad(D)) + D.translation().norm();
}

double AdaptiveThreshold::sigma_th_m() const { return within_bounds(widening_); }

double AdaptiveThreshold::usual_sigma_th_m() const { return within_bounds(1.0); }

double AdaptiveThreshold::within_bounds(double widening) const {
  const double sigma = weight_ > 0.0 ? std::sqrt(weighted_squares_ / weight_) : config_.initial_m;
  return std::clamp(sigma * widening, config_.floor_m, config_.ceiling_m);
}

void AdaptiveThreshold::update(const SE3& T_init, const SE3& T_new, const Eigen::Vector3d& acceleration) {
  // γ_i = exp(−α_i / (Δt σ_decay)) with the sweep as unit of time (Δt = 1): with m/s² one centimetre of noise would be
  // 1 m/s², and γ would vanish always.
  const double alpha = (acceleration - last_acceleration_).norm();
  last_acceleration_ = acceleration;
  gamma_ = std::exp(-alpha / config_.decay);
  deviation_m_ = model_deviation_m(T_init, T_new, config_);
  weighted_squares_ = config_.forgetting * weighted_squares_ + gamma_ * deviation_m_ * deviation_m_;
  weight_ = config_.forgetting * weight_ + 1.0;
  widening_ = 1.0;
}

void AdaptiveThreshold::widen() { widening_ = std::min(2.0 * widening_, kMaxWidening); }

void AdaptiveThreshold::reset() { *this = AdaptiveThreshold(config_); }

}  // namespace rilo
