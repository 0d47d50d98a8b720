// What the pipeline does to end in time (docs/method.md, time budget).
#include <functional>

#include "cloud/thinning.hpp"
#include "odometry/pipeline.hpp"

namespace rilo {

/// When work has to end that leaves so much time for what follows.
Deadline Pipeline::deadline(double reserve_ms) const {
  return budget_.limited() ? clock_.deadline(budget_.target_ms() - reserve_ms) : Deadline();
}

/// Leaves so many of the points of the present sweep.
void Pipeline::thin(const PreparedSweep& prepared, double share, SweepStats& stats) {
  if (share < 1.0) {
    preprocessor_.thin(share);
    stats.points_source = prepared.source.size();
    stats.points_map = prepared.map_cloud.size();
    stats.points_cut = true;
  }
}

/// Learns what a usual sweep costs after its preparation.
void Pipeline::learn_rest(const Registration& registration, const SweepResult& result) {
  if (established() && result.status != OdometryStatus::kRecovered && registration.starts == 1) {
    const double coarse_ms = result.stats.coarse_ran ? result.stats.times.initial_pose_ms : 0.0;
    const double took_ms = clock_.total_ms() - result.stats.times.preprocess_ms - coarse_ms;
    // A registration that was cut would have taken longer.
    const bool late = registration.icp.termination == IcpTermination::kTimeLimit;
    budget_.learn(Work::kRest, shares_.source, (late ? UsualTime::kSlowest : 1.0) * took_ms);
  }
}

/// Puts a sweep into the map, or as many of its points as there is time for.
void Pipeline::insert(const TimedCloud& cloud, SweepResult& result,
                      const std::function<void(const TimedCloud&)>& into_map) {
  const double begin_ms = clock_.total_ms();
  const auto points = static_cast<double>(cloud.size());
  const double share = budget_.share_in_time(budget_.ms(Work::kInsert, points), config_.budget.sweep_ms - begin_ms);
  if (share < 1.0) {
    result.stats.points_cut = true;
    into_map(thinned(cloud, share));
  } else {
    into_map(cloud);
  }
  budget_.learn(Work::kInsert, share * points, clock_.total_ms() - begin_ms);
}

}  // namespace rilo
