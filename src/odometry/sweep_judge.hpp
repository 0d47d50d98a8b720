// The status of registered sweeps, and when a map that no longer fits is given up.
#pragma once

#include <cstddef>

#include "odometry/motion_tracker.hpp"
#include "odometry/registration.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// What is known of the sweeps before the one that is judged.
struct JudgedAgainst {
  std::size_t map_sweeps = 0;  ///< sweeps in the map
  double usual_score = 0;      ///< map score of the sweeps before
  double usual_quality = 0;    ///< quality_of() of them
  bool was_lost = false;       ///< the sweep before was lost
  bool after_gap = false;      ///< sweeps are missing since the last one that was accepted
  bool stayed = false;         ///< the sensor has not moved since that
};

/// Verdict on one registered sweep.
struct Judgement {
  OdometryStatus status = OdometryStatus::kLost;
  MotionVerdict motion = MotionVerdict::kPossible;
  LossCause cause = LossCause::kNone;  ///< of kLost

  /// True with kLost: the pose would be right if the motion to it were possible.
  bool fits_map() const { return cause == LossCause::kNone || cause == LossCause::kImpossibleMotion; }
};

class SweepJudge {
 public:
  explicit SweepJudge(const HealthConfig& config) : config_(config) {}

  Judgement judge(const PreparedSweep& prepared, const Registration& registration, MotionVerdict motion,
                  const JudgedAgainst& before) const;

  /// The sweep goes into the map.
  void accept(const PreparedSweep& prepared, const Registration& registration, bool degenerate);
  /// The sweep begins a map; `covered`: of what may cover the sensor.
  void begin(const PreparedSweep& prepared, bool covered);
  /// Counts a lost sweep. True when the map has not fitted for too long, missing sweeps included: `since_last` periods
  /// after the last one that did. A map that is not `established` may itself be the wrong one and is given up at once.
  /// A covered sensor says nothing against the map.
  bool give_up(bool established, double since_last, LossCause cause);
  int lost_in_a_row() const { return lost_in_a_row_; }

  void reset() { *this = SweepJudge(config_); }

 private:
  /// What a sweep shows of a place, beside the sweeps before.
  struct View {
    bool degenerate = false;
    bool less = false;  ///< of its weakest direction, much less than usual
    bool after_gap = false;
    bool map_may_end = false;  ///< where the sensor is now, after a gap
  };
  View view_of(const Registration& registration, const JudgedAgainst& before) const;
  /// Whether the sweep fits worse than usual, or elsewhere as well.
  LossCause misplaced(const Registration& registration, const View& view, MotionVerdict motion,
                      const JudgedAgainst& before) const;
  bool fits_closely(const Registration& registration, double usual_quality) const;

  HealthConfig config_;
  double median_range_m_ = 0;    // of the last sweep in the map
  double usual_residual_m_ = 0;  // of the sweeps in the map; 0: unknown
  double usual_eigenvalue_ = 0;  // least relative one of the sweeps in the map; 0: unknown
  double unseen_share_ = 0;      // of the sweeps in the map: degenerate ones
  bool begun_covered_ = false;   // the map
  int lost_in_a_row_ = 0;
  int tried_in_a_row_ = 0;  // of them: those that were not covered
  int begun_in_a_row_ = 0;  // maps, without a second sweep
};

}  // namespace rilo
