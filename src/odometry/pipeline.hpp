// The stages of the odometry and the state that they share.
#pragma once

#include <functional>
#include <optional>

#include <tbb/task_arena.h>

#include "calibration/sensor_calibration.hpp"
#include "cloud/fingerprint.hpp"
#include "cloud/more_workers.hpp"
#include "cloud/preprocess.hpp"
#include "odometry/adaptive_threshold.hpp"
#include "odometry/initial_pose.hpp"
#include "odometry/motion_tracker.hpp"
#include "odometry/pose_covariance.hpp"
#include "odometry/registration.hpp"
#include "odometry/stage_clock.hpp"
#include "odometry/sweep_clock.hpp"
#include "odometry/sweep_judge.hpp"
#include "odometry/sweep_map.hpp"
#include "odometry/time_budget.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo {

/// One call per sweep, one function per stage, in the order of docs/method.md.
class Pipeline {
 public:
  /// @throws as the constructor of Odometry.
  Pipeline(const OdometryConfig& config, Odometry::Clock clock);

  SweepResult register_sweep(const SweepView& sweep);

  /// `known`: in place of the configured angles.
  void reset(const std::optional<SensorAngles>& known);
  SensorAngles sensor_angles() const { return calibration_.angles(); }
  double start_over(const std::optional<KnownVelocity>& velocity);

  const Trajectory& trajectory() const { return trajectory_; }
  const SweepMap& map() const { return map_; }
  void keep_intensities(bool kept) { preprocessor_.keep_intensities(kept); }

 private:
  void process(const SweepView& sweep, SweepResult& result);
  const PreparedSweep& prepare(const SweepView& sweep, SweepResult& result);
  void register_to_map(const PreparedSweep& prepared, SweepResult& result);
  MotionState predict(const PreparedSweep& prepared);
  InitialPose choose_initial_pose(const PreparedSweep& prepared, const MotionState& predicted, SweepResult& result);
  RegistrationContext registration_context(const PreparedSweep& prepared);
  Registration register_finely(const PreparedSweep& prepared, const MotionState& predicted, const InitialPose& init,
                               SweepResult& result);
  Judgement judge(const PreparedSweep& prepared, const Registration& registration, SweepResult& result);
  void accept(const PreparedSweep& prepared, Registration registration, MotionVerdict motion, SweepResult& result);
  Matrix6d covariance_of(const PreparedSweep& prepared, const Registration& registration, const Vector6d& twist_before,
                         bool vague);
  void lose(const PreparedSweep& prepared, const MotionState& predicted, const std::optional<SE3>& claim,
            SweepResult& result);
  void begin_map(const PreparedSweep& prepared, const MotionState& guess, SweepResult& result);
  void thin(const PreparedSweep& prepared, double share, SweepStats& stats);
  void learn_rest(const Registration& registration, const SweepResult& result);
  void insert(const TimedCloud& cloud, SweepResult& result, const std::function<void(const TimedCloud&)>& into_map);
  void finish(SweepResult& result);

  bool established() const;
  double period_s() const;
  /// Time since the last sweep that was accepted.
  double periods_since_trusted() const;
  /// Whether sweeps are missing since then, those that were lost left out.
  bool after_gap() const;
  /// Where the sensor may be, after a gap.
  std::optional<Reach> reach() const;
  bool in_doubt() const;
  Deadline deadline(double reserve_ms) const;

  OdometryConfig config_;
  StageClock clock_;
  MoreWorkers workers_;
  tbb::task_arena arena_;
  TimeBudget budget_;
  PointShares shares_;  // of this sweep
  Sweep thinned_;
  Preprocessor preprocessor_;
  SweepClock sweep_clock_;
  MotionTracker tracker_;
  InitialPoseStage initial_pose_;
  SweepJudge judge_;
  AdaptiveThreshold threshold_;
  PoseCovariance pose_covariance_;
  SensorCalibration calibration_;
  SweepMap map_;
  Trajectory trajectory_;
  Fingerprint fingerprint_;                              // of the last sweep
  bool contradicted_ = false;                            // a sweep since the last accepted one did not fit the map
  bool repeated_ = false;                                // this sweep is the last one again
  Eigen::Vector3d last_step_ = Eigen::Vector3d::Zero();  // displacement of the last sweep, sensor frame
};

}  // namespace rilo
