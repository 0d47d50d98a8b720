// Point-to-plane adaptive ICP from a sweep to the local map (III-D, Algorithm 2).
#pragma once

#include <cstddef>
#include <vector>

#include "rilo/cloud/timed_cloud.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/map/local_map.hpp"
#include "rilo/registration/adaptive_icp_config.hpp"
#include "rilo/registration/degeneracy.hpp"
#include "rilo/registration/normal_equations.hpp"

namespace rilo {

/// Pose and velocity of the sensor at the reference instant of a sweep.
struct MotionState {
  SE3 T_odom_lidar = SE3::Identity();
  Vector6d twist = Vector6d::Zero();  ///< body velocity [rad/s; m/s]
};

/// What is known of the state before the sweep is looked at. Perturbations: rotation and translation of the sensor
/// about its own origin along the axes of the odometry frame, then their rates.
struct MotionPrior {
  MotionState state;
  Matrix12d information = Matrix12d::Zero();  ///< zero: nothing is known
};

/// Result of the registration.
struct IcpResult {
  MotionState state;
  bool converged = false;
  int iterations = 0;
  std::size_t inliers = 0;
  double residual_rms_m = 0;
  Matrix6d lidar_information = Matrix6d::Zero();        ///< of the pose, sweep alone, same perturbation as MotionPrior
  Matrix12d sweep_information = Matrix12d::Zero();      ///< of pose and velocity, sweep alone, weak directions faded
  Matrix12d posterior_information = Matrix12d::Zero();  ///< the same and the prior's
  PoseDegeneracy degeneracy;
};

/// The planes that the points of one source cloud were matched with in one state of the map, kept from one iteration to
/// the next: the last ones move the sweep by millimetres and meet the same planes again.
class PlaneMatches {
 public:
  /// `rematch_m`: how far the sweep may move before its planes are looked up again; 0: not at all.
  explicit PlaneMatches(double rematch_m) : rematch_m_(rematch_m) {}

  /// linearise() below, on the planes kept where `state` is near enough to where they were looked up.
  NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                            const AdaptiveIcpConfig& config, std::size_t stride);

  /// What errors of the normals alone add to the Hessian of the pose, on average: directions in which the Hessian is
  /// not larger are not observed, whatever its eigenvalues say.
  const Matrix6d& normal_noise() const { return normal_noise_; }

 private:
  struct Match {
    Eigen::Vector3d normal;
    double distance = 0;  // of the plane from the origin along its normal (m)
    bool found = false;
  };
  /// Forgets the planes: those of `count` points, every stride-th, are to be looked up at `state`.
  void begin(const TimedCloud& source, const MotionState& state, std::size_t stride, std::size_t count);
  void measure(const TimedCloud& source);
  bool near(const MotionState& state) const;

  double rematch_m_;
  std::vector<Match> matches_;  // of every stride-th point
  std::size_t stride_ = 0;      // 0: none are kept
  MotionState state_;           // at which they were looked up
  Matrix6d normal_noise_ = Matrix6d::Zero();
  double lever_m_ = 0;      // typical range of a point
  double half_span_s_ = 0;  // largest offset of a point from the instant of the pose
};

/// Residuals and Jacobians of `source` against the planes of `map` at `state`, with the Cauchy weight of σ_th (eq.
/// β_k), summed. The pose is perturbed as described at MotionPrior. Only every `stride`-th point is looked at.
NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                          const AdaptiveIcpConfig& config, std::size_t stride = 1);

/// Moves `state` by the perturbation [rotation; translation; their rates].
MotionState perturbed(const MotionState& state, const Vector12d& delta);

/// Aligns `source` with `map` from `initial`, weights from `sigma_th_m`.
IcpResult adaptive_icp(const TimedCloud& source, const LocalMap& map, const MotionState& initial,
                       const MotionPrior& prior, double sigma_th_m, const AdaptiveIcpConfig& config);

}  // namespace rilo
