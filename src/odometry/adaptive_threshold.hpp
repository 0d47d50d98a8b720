// Adaptive threshold from current and historical error (III-C).
#pragma once

#include "rilo/geometry/se3.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// σ_th: how far the registration usually moves the initial pose, weighted by the steadiness of the motion.
class AdaptiveThreshold {
 public:
  explicit AdaptiveThreshold(const AdaptiveThresholdConfig& config) : config_(config) {}

  /// σ_th (m) for the next sweep, within floor and ceiling.
  double sigma_th_m() const;
  /// The same (m) without the growth after failures.
  double usual_sigma_th_m() const;

  /// Learns from a registered sweep.
  /// @param T_init,T_new initial and registered pose.
  /// @param acceleration change of the displacement since the last accepted sweep against the one before (m); missing
  /// sweeps in between make it longer.
  void update(const SE3& T_init, const SE3& T_new, const Eigen::Vector3d& acceleration);

  /// After a sweep that could not be registered the threshold grows, so that the next one may find its way back.
  void widen();

  void reset();

  double gamma() const { return gamma_; }              ///< γ_i of the last update
  double deviation_m() const { return deviation_m_; }  ///< e_i of the last update

 private:
  double within_bounds(double widening) const;

  AdaptiveThresholdConfig config_;
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
  double weighted_squares_ = 0;  // Σ γ e², past discounted
  double weight_ = 0;            // N, past discounted
  double widening_ = 1;          // factor on σ_th after failures
  double gamma_ = 1;
  double deviation_m_ = 0;
};

/// e_i: σ_max tanh(β θ) + |t| of the model deviation T_init⁻¹ T_new (m).
double model_deviation_m(const SE3& T_init, const SE3& T_new, const AdaptiveThresholdConfig& config);

}  // namespace rilo
