// Writes the reports of the stages into the statistics of a sweep.
#pragma once

#include "calibration/sensor_calibration.hpp"
#include "cloud/preprocess.hpp"
#include "odometry/initial_pose.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

void record(const SweepView& sweep, const PreparedSweep& prepared, SweepStats& stats);
void record(const InitialPose& init, SweepStats& stats);
/// After the record of the prepared sweep.
void record(const IcpResult& icp, SweepStats& stats);
void record(const SensorCalibration& calibration, SweepStats& stats);

}  // namespace rilo
