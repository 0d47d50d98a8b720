// Figures of a run or of another program's poses: what metrics.json and the cells of a benchmark hold.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rilo/io/scan_source.hpp"

namespace rilo {

using MaybeNumber = std::optional<double>;
using MaybeCount = std::optional<std::size_t>;

/// Time per sweep, ms. Percentiles as in rilo/evaluation/percentile.hpp.
struct TimingMetrics {
  MaybeNumber mean, median, p95, p99, max;
  friend bool operator==(const TimingMetrics&, const TimingMetrics&) = default;
};

/// Mean time of the stages per sweep, ms.
struct StageMetrics {
  double preprocess = 0;
  double initial_pose = 0;
  double registration = 0;
  double map = 0;
  friend bool operator==(const StageMetrics&, const StageMetrics&) = default;
};

/// As ErrorSummary.
struct ErrorMetrics {
  MaybeNumber rmse, mean, std, median, max;
  friend bool operator==(const ErrorMetrics&, const ErrorMetrics&) = default;
};

/// As Evaluation.
struct EvaluationMetrics {
  MaybeCount poses;
  MaybeNumber path_m;
  MaybeNumber t_rel_pct, r_rel_deg_per_100m;
  std::string t_rel_protocol;
  ErrorMetrics ape_m, ape_rotation_deg, ape_unaligned_m, ape_unaligned_rotation_deg;
  ErrorMetrics rpe_frame_m, rpe_frame_deg, rpe_metre_m_per_m, rpe_metre_deg_per_m;
  MaybeNumber end_error_m, end_error_pct;
  std::string truth;          ///< file of the true poses
  std::string truth_instant;  ///< what they refer to
  friend bool operator==(const EvaluationMetrics&, const EvaluationMetrics&) = default;
};

/// Sweeps on which something was left undone because of the time budget.
struct BudgetMetrics {
  double sweep_ms = 0;
  std::size_t points_cut = 0;
  std::size_t coarse_cut = 0;
  std::size_t over_budget = 0;
  friend bool operator==(const BudgetMetrics&, const BudgetMetrics&) = default;
};

/// As CompensationTrial: raw or compensated; neither: not certain.
struct TrialMetrics {
  std::string times;  ///< "auto": their own
  std::size_t sweeps = 0;
  std::size_t better = 0;
  std::size_t on_cones = 0;
  std::size_t off_cones = 0;
  std::size_t lost = 0;
  bool raw = false;
  bool compensated = false;
  friend bool operator==(const TrialMetrics&, const TrialMetrics&) = default;
};

using Counts = std::map<std::string, std::size_t>;  // by name

/// Of a peer only `evaluation` and what is known of its effort; everything else is empty.
struct RunMetrics {
  std::string rilo_version;
  std::string command;
  std::string data;
  std::string data_path;  ///< the same, absolute: a relative one is valid in one folder only
  std::string format;
  MaybeCount frames;  ///< sweeps
  bool interrupted = false;
  std::string error;
  TimingMetrics ms;  ///< of the whole sweep
  std::string ms_note;
  StageMetrics stage_mean_ms;
  MaybeNumber wall_s;
  MaybeNumber peak_rss_mb;
  int threads = 0;

  std::string pose_instant;
  std::string point_times;
  bool motion_compensation = false;
  std::optional<TrialMetrics> compensation;  ///< of points without times
  MaybeNumber elevation_correction_deg;      ///< given
  std::string topic;
  std::string frame_id;
  std::size_t parts = 0;  ///< of the data, that were joined to a sweep; 0: not known
  std::size_t bad_sweeps = 0;
  StampFaults stamp_faults;
  std::vector<std::string> warnings;

  Counts status;
  Counts loss_causes;  ///< of the sweeps that were lost, those a map begins with among them
  Counts initial_pose;
  Counts initial_pose_reasons;
  std::size_t coarse_runs = 0;
  MaybeNumber mean_iterations;
  MaybeCount flake_sweeps;  ///< whose isolated returns were dropped; both or none
  MaybeNumber flakes_pct;   ///< of their returns within range
  std::optional<BudgetMetrics> budget;

  std::string calibration;                                       ///< file that the run began with
  MaybeNumber elevation_given_deg;                               ///< by a calibration, or elevation.initial_deg
  MaybeNumber elevation_initial_deg;                             ///< that the first sweep was corrected by
  MaybeNumber elevation_offset_deg, elevation_offset_sigma_deg;  ///< estimated; both or none
  MaybeNumber elevation_offset_applied_deg;                      ///< on top of the given correction
  MaybeCount started_over_after_sweeps;
  double beam_elevation_rms_deg = 0;
  double beam_azimuth_rms_deg = 0;

  EvaluationMetrics evaluation;
  std::string truth_error;

  // Of a cell of a benchmark alone.
  MaybeNumber selection_rate_pct, coarse_rate_pct;  ///< of the sweeps
  std::optional<bool> elevation_estimated;
  MaybeCount repeats;

  bool evaluated() const { return evaluation != EvaluationMetrics{}; }
  bool timed() const { return ms != TimingMetrics{}; }
};

}  // namespace rilo
