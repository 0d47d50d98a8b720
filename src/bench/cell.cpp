#include "bench/cell.hpp"

#include "console/failure.hpp"
#include "results/pose_files.hpp"
#include "results/run_metrics.hpp"
#include "results/run_observers.hpp"
#include "results/run_record.hpp"
#include "results/run_truth.hpp"

namespace rilo {

namespace {

GivenPoses given(const BenchSequence& sequence, const std::filesystem::path& file) {
  return {file, sequence.camera_frame, sequence.max_gap_s};
}

std::optional<GivenPoses> truth_file(const BenchSequence& sequence) {
  if (sequence.ground_truth.empty()) return std::nullopt;
  return given(sequence, sequence.ground_truth);
}

double share_pct(std::size_t part, std::size_t of) {
  return of == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(of);
}

RunMetrics metrics_of(const RunRecord& run) {
  RunMetrics metrics = run_metrics(run);
  metrics.selection_rate_pct = share_pct(metrics.initial_pose["coarse"], run.results.size());
  metrics.coarse_rate_pct = share_pct(metrics.coarse_runs, run.results.size());
  metrics.elevation_estimated = run.config.elevation.enabled;
  return metrics;
}

template <typename Work>
void guarded(BenchCell& cell, const Work& work) {
  try {
    work();
  } catch (...) {
    const Failure failure = current_failure();
    cell.error = failure.message;
    cell.error_code = failure.code;
  }
}

void run(const RunRequest& flags, const BenchSequence& sequence, RunRecord& record, BenchCell& cell) {
  record.data = flags.data;
  record.calibration = flags.calibration;
  const auto truth = truth_file(sequence);
  if (truth) read_poses(truth->file);  // rather found out now than after the run
  Session session(source_of(flags), session_options(flags, record.config));
  SweepCheck check(flags);
  ProgressLine progress(flags, session.source());
  session.add(check);
  session.add(progress);
  take(session.run(), record);
  if (record.signal != 0) return;
  if (!record.error.empty()) throw RunError(kind_of(record.error_code), record.error);
  evaluate_run(record, truth);
  cell.metrics = metrics_of(record);
  if (record.evaluation) cell.kitti = record.evaluation->kitti;
}

BenchCell peer_cell(const BenchSequence& sequence, const BenchPeer& peer, const RunRecord& record) {
  BenchCell cell{sequence.name, peer.name, true, {peer.poses.string()}, {}, {}, {}, kSuccess};
  guarded(cell, [&] {
    const PosesOfSweeps poses = poses_of_sweeps(given(sequence, peer.poses), record);
    const auto truth = truth_of_sweeps(record, truth_file(sequence));
    if (!truth)
      throw RunError(RunErrorKind::kBadData, sequence.path.string() + ": no ground truth to compare a peer with");
    const TruthMatch match = match_truth(*truth, poses);
    const Evaluation evaluation = evaluate(match.truth, match.estimate);
    cell.metrics.evaluation = evaluation_metrics(evaluation, match);
    cell.kitti = evaluation.kitti;
  });
  return cell;
}

}  // namespace

RunRequest run_request(const BenchSequence& sequence, const BenchRunOptions& flags) {
  RunRequest run;
  run.data = sequence.path.string();
  run.start = sequence.start;
  run.count = flags.count > 0 ? flags.count : sequence.count;
  run.calibration = sequence.calibration.string();
  run.quiet = flags.quiet;
  run.source = flags.source;
  if (sequence.point_times) {
    run.source.options.point_times = *sequence.point_times;
    run.source.times_needed = false;
  }
  if (sequence.elevation_correction_deg) {
    run.source.options.elevation_correction_deg = *sequence.elevation_correction_deg;
  }
  return run;
}

std::vector<BenchCell> run_cell(const BenchSequence& sequence, const BenchConfiguration& configuration,
                                const BenchRunOptions& flags) {
  RunRecord record;
  record.config = configuration.config;
  if (flags.threads >= 0) record.config.threads = flags.threads;
  std::vector<BenchCell> cells = {
      {sequence.name, configuration.name, false, configuration.settings, {}, {}, {}, kSuccess}};
  guarded(cells.front(), [&] { run(run_request(sequence, flags), sequence, record, cells.front()); });
  if (record.signal != 0) return {};
  if (cells.front().failed()) return cells;
  for (const BenchPeer& peer : sequence.peers) cells.push_back(peer_cell(sequence, peer, record));
  return cells;
}

}  // namespace rilo
