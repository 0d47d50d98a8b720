// What the stages report, written into the statistics of a sweep.
#pragma once

#include "rilo/cloud/preprocess.hpp"
#include "rilo/odometry/initial_pose.hpp"
#include "rilo/odometry/sweep_result.hpp"
#include "rilo/registration/adaptive_icp.hpp"

namespace rilo {

void record(const SweepView& sweep, const PreparedSweep& prepared, SweepStats& stats);
void record(const InitialPose& init, SweepStats& stats);
/// After the record of the prepared sweep.
void record(const IcpResult& icp, SweepStats& stats);

}  // namespace rilo
