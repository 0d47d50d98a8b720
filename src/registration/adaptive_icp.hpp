// Point-to-plane adaptive ICP from a sweep to the local map (III-D, Algorithm 2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud/deskew.hpp"
#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"
#include "registration/deadline.hpp"
#include "registration/degeneracy.hpp"
#include "registration/normal_equations.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Velocity of the sensor before.
struct EarlierVelocity {
  Vector6d twist = Vector6d::Zero();         ///< body velocity [rad/s; m/s]
  double lag_s = 0;                          ///< so long before; 0: not known
  Vector6d acceleration = Vector6d::Zero();  ///< until then [rad/s²; m/s²]
  double share = 0;  ///< of the change from that acceleration to the one since then goes on; 0: not known
};

/// Pose and velocity of the sensor at the reference time of a sweep.
struct MotionState {
  SE3 T_odom_lidar = SE3::Identity();
  Vector6d twist = Vector6d::Zero();  ///< body velocity [rad/s; m/s]
  EarlierVelocity earlier = {};       ///< from which it changed steadily

  /// Mean acceleration since the earlier velocity [rad/s²; m/s²]; 0 where that is not known.
  Vector6d mean_acceleration() const {
    return earlier.lag_s > 0.0 ? Vector6d((twist - earlier.twist) / earlier.lag_s) : Vector6d(Vector6d::Zero());
  }

  /// During the sweep, at the acceleration since the earlier velocity and what of its own change goes on: none where
  /// that is not known.
  BodyMotion motion() const {
    const Vector6d mean = mean_acceleration();
    return {twist, mean + earlier.share * (mean - earlier.acceleration)};
  }

  /// The same at constant velocity: what a guess may say of the motion.
  MotionState steady() const { return {T_odom_lidar, twist}; }

  /// The velocity along the axes of the odometry frame, as perturbations are.
  Vector6d twist_in_odom() const {
    Vector6d twist_odom;
    twist_odom << T_odom_lidar.linear() * twist.head<3>(), T_odom_lidar.linear() * twist.tail<3>();
    return twist_odom;
  }

  /// Derivative (s) of the motion to `offset_s` by the velocity, with which the acceleration changes, too.
  double velocity_lever_s(double offset_s) const {
    const double growth = 1.0 + earlier.share;
    return earlier.lag_s > 0.0 ? offset_s + 0.5 * growth * offset_s * offset_s / earlier.lag_s : offset_s;
  }
};

/// Prior knowledge of the state. Perturbations: rotation and translation of the sensor
/// about its own origin along the axes of the odometry frame, then their rates.
struct MotionPrior {
  MotionState state;
  Matrix12d information = Matrix12d::Zero();  ///< zero: none
};

/// Why the registration ended.
enum class IcpTermination : std::uint8_t {
  kConverged,       ///< the last update was below the thresholds
  kIterationLimit,  ///< it was not, after as many iterations as are allowed
  kSingular,        ///< too few correspondences, or a singular system
  kTimeLimit,       ///< the deadline passed
};

/// Result of the registration.
struct IcpResult {
  MotionState state;
  IcpTermination termination = IcpTermination::kIterationLimit;
  int iterations = 0;
  Vector6d last_update = Vector6d::Zero();  ///< of the pose, perturbation as of MotionPrior
  bool frozen = false;                      ///< points were held to their correspondences for it to converge
  std::size_t inliers = 0;
  double residual_rms_m = 0;
  double unit_information = 0;                      ///< of a residual with weight 1 (1/m²), in all information below
  Matrix6d lidar_information = Matrix6d::Zero();    ///< of the pose, sweep alone, same perturbation as MotionPrior
  Matrix12d sweep_information = Matrix12d::Zero();  ///< of pose and velocity, sweep alone, weak directions faded
  Matrix12d posterior_information = Matrix12d::Zero();  ///< the same and the prior's
  PoseDegeneracy degeneracy;

  bool converged() const { return termination == IcpTermination::kConverged; }
};

/// Correspondences of one source cloud in one state of the map, kept from one iteration to the next: a point that stays
/// in its finest voxel keeps its plane.
class PlaneMatches {
 public:
  /// linearise() below, with the correspondences kept for the same source and map.
  NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                            const AdaptiveIcpConfig& config, std::size_t stride);

  /// From now on every point keeps its last correspondence, wherever it moves.
  void freeze() { frozen_ = true; }

  /// The part of the Hessian of the pose that wider planes do not confirm: Σ β (J Jᵀ − ½ (J J_wᵀ + J_w Jᵀ)), J with the
  /// normal of a point's plane, J_w with that of a wider one around it. Their errors hardly go together, so that J J_wᵀ
  /// is, on average, free of what errors of the normals add to J Jᵀ: along a tunnel they are all that it shows.
  const Matrix6d& unconfirmed() const { return unconfirmed_; }

 private:
  enum class Meets : std::uint8_t { kUnknown, kNothing, kPlane, kScatter };
  /// What every iteration reads.
  struct Match {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float weight = 0.0F;
    double distance_m = 0;  // of the plane from the origin along its normal
    VoxelIndex voxel;       // the finest one, that of the point when it was looked up
    Meets meets = Meets::kUnknown;
  };
  struct WiderNormal {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    bool known = false;  // only where it was asked for
  };
  void begin(const TimedCloud& source);
  /// Finds the correspondences of those of the points `first`, `first` + 1, … of the strided cloud meet that have left
  /// their voxel.
  void look_up(const LocalMap& map, std::size_t first, std::span<const Eigen::Vector3d> world, std::size_t stride);

  /// The normal of a wider plane around that of the point `i`, to the same side; its own when there is none.
  const Eigen::Vector3f& wider_normal(const LocalMap& map, std::size_t i);

  /// What the point `i` reads from the map in every iteration.
  void prefetch(std::size_t i) const {
    if (matches_[i].meets == Meets::kScatter) {
      spots_[i].grid->prefetch_scatter(spots_[i]);
    }
  }

  std::vector<Match> matches_;      // of all points
  std::vector<PlaneSpot> spots_;    // where they are met
  std::vector<WiderNormal> wider_;  // of every kSparseStride-th point
  std::optional<TimeSpan> span_;    // of the source
  bool frozen_ = false;
  Matrix6d unconfirmed_ = Matrix6d::Zero();
};

/// Residuals and Jacobians of `source` against the planes of `map` at `state`, with the Cauchy weight of σ_th (eq.
/// β_k), summed. The pose is perturbed as described at MotionPrior. Only every `stride`-th point is used.
NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                          const AdaptiveIcpConfig& config, std::size_t stride = 1);

/// Perturbation of `prior`'s mean at which `state` lies.
Vector12d prior_error(const MotionPrior& prior, const MotionState& state);

/// Moves `state` by the perturbation [rotation; translation; their rates].
MotionState perturbed(const MotionState& state, const Vector12d& delta);

/// Aligns `source` with `map` from `initial`, weights from `sigma_th_m`. After the deadline no iteration begins, but
/// one of all points is made in any case, unless config.max_iterations is 1.
IcpResult adaptive_icp(const TimedCloud& source, const LocalMap& map, const MotionState& initial,
                       const MotionPrior& prior, double sigma_th_m, const AdaptiveIcpConfig& config,
                       const Deadline& deadline = {});

}  // namespace rilo
