// A sweep as registered, and what its registration reads.
#pragma once

#include <optional>

#include "cloud/preprocess.hpp"
#include "geometry/pose_derivative.hpp"
#include "odometry/initial_pose.hpp"
#include "odometry/motion_tracker.hpp"
#include "odometry/sweep_map.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// The first sweep of a map, as the second one shows it.
struct FirstSweep {
  std::optional<LocalMap> map;        ///< of it alone, compensated with `twist`, if timed
  Vector6d twist = Vector6d::Zero();  ///< body velocity [rad/s; m/s]
};

/// A sweep as registered, before it is judged.
struct Registration {
  IcpResult icp;
  SE3 T_init = SE3::Identity();     ///< initial pose of the registration that was kept
  std::optional<FirstSweep> first;  ///< second sweep of a map
  double sigma_th_m = 0;            ///< the registration was weighted with
  double score = 0;                 ///< map score at the registered pose
  double quality = 0;               ///< see quality_of()
  bool stands_out = true;           ///< over the places beside it; see rilo::stands_out()
  bool ambiguous = false;           ///< it may as well lie elsewhere
  int starts = 1;                   ///< how many it was chosen from
  bool cut = false;                 ///< no time for further ones
};

/// The sweep and the state of the odometry that registering it reads; they outlive it.
struct RegistrationContext {
  const OdometryConfig& config;
  const PreparedSweep& prepared;
  const MotionTracker& tracker;
  const SweepMap& map;
  InitialPoseStage& initial_pose;
  const PoseDerivative& pose_by_elevation;
  double sigma_th_m = 0;
  double usual_sigma_th_m = 0;  ///< the same without the growth after failures
  double period_s = 0;          ///< usual time between sweeps
  bool after_gap = false;       ///< sweeps are missing before this one
  bool contradicted = false;    ///< a sweep since the trusted one did not fit; false: they were empty
  Deadline deadline = {};       ///< of the registration
  double first_map_ms = 0;      ///< how long it takes to put the first sweep into a map, and this one
};

}  // namespace rilo
