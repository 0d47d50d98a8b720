#include "bench/report_sequence.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bench/figures.hpp"
#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "results/pose_files.hpp"
#include "results/run_report.hpp"
#include "results/run_truth.hpp"
#include "rilo/evaluation/pose_error.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

/// A report, and where its frame lies in that of the truth.
struct Placed {
  RunReport report;
  std::optional<SE3> T_world_odom;  ///< nothing without truth
};

std::string with_sentences(const std::vector<std::string>& sentences, const std::string& first) {
  std::string text = first;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence + ".";
  return text;
}

/// The truth that the user gave, for one run. For a data folder, the truth in it.
void evaluate_given(const fs::path& truth, const PoseFlags& flags, RunRecord& run) {
  if (!detail::is_folder(truth)) {
    evaluate_run(run, GivenPoses{truth, flags.camera_frame, flags.max_gap_s});
    return;
  }
  run.data = truth;
  evaluate_run(run, std::nullopt);
  if (!run.evaluation) {
    throw IoError({truth, "", "no ground truth", "poses.txt, poses_mid.txt or poses_velo.txt in it",
                   "Give the pose file itself after --gt"});
  }
}

void evaluate_saved(const ReportSequence& sequence, const PoseFlags& flags, SavedRun& run) {
  if (run.record.results.size() < 2) return;
  if (!sequence.truth.empty()) {
    evaluate_given(sequence.truth, flags, run.record);
    return;
  }
  evaluate_run(run.record);
  if (run.record.evaluation || !run.metrics.evaluated()) return;
  if (!run.record.truth_error.empty()) {
    run.notices.push_back("The true poses cannot be used: " + run.record.truth_error);
    return;
  }
  const std::string& file = run.metrics.evaluation.truth;
  run.notices.push_back(fmt::format(
      "The true poses ({}) are not where they were: figures are those of the run, curves of errors are missing; --gt "
      "says where the truth is",
      file.empty() ? "unknown" : file));
}

std::map<std::string, double> recorded_figures(const RunMetrics& metrics) {
  std::map<std::string, double> figures;
  for (const BenchFigure& figure : bench_figures()) {
    if (const MaybeNumber& value = figure.get(metrics)) figures[figure.key] = *value;
  }
  if (metrics.evaluation.end_error_m) figures["end_error_m"] = *metrics.evaluation.end_error_m;
  return figures;
}

Placed placed_run(const ReportSequence& sequence, const ReportEntry& entry) {
  const SavedRun& saved = *entry.run;
  Placed placed{report_of(saved.record, saved.metrics), std::nullopt};
  RunReport& report = placed.report;
  report.title = entry.input.name;
  report.notice = with_sentences(saved.notices, report.notice);
  report.recorded = recorded_figures(saved.metrics);
  report.facts.insert(report.facts.begin(), {"Results", valid_utf8(saved.folder.string())});
  if (saved.killed) {
    report.facts.resize(1);
    report.sweeps.clear();  // nothing is known of them
    report.dataset.clear();
  }
  if (saved.record.map.points.empty()) {
    report.facts.emplace_back("Map", "none in the folder; rilo run --map FOLDER/map.ply leaves one");
  }
  if (saved.record.truth) {
    placed.T_world_odom = saved.record.truth->truth.front() * saved.record.truth->estimate.front().inverse();
  }
  report.name = entry.input.name;
  report.sequence = sequence.name;
  return placed;
}

/// Poses of another program and the true ones at the same times; `truth` stays empty when there is none.
struct PairedPeer {
  std::vector<SE3> estimate;
  std::vector<SE3> truth;
  std::pair<std::string, std::string> protocol;
  std::vector<std::size_t> sweeps;  // their places in the data; empty where these are not known
};

/// On the sweeps of the run beside them.
PairedPeer on_sweeps_of(const RunRecord& run, const ReportSequence& sequence, const GivenPoses& given) {
  PairedPeer peer;
  const PosesOfSweeps poses = poses_of_sweeps(given, run);
  if (run.truth) {
    std::optional<GivenPoses> file;
    if (!sequence.truth.empty() && !detail::is_folder(sequence.truth)) {
      file = GivenPoses{sequence.truth, given.camera_frame, given.max_gap_s};
    }
    TruthMatch match = match_truth(*truth_of_sweeps(run, file), poses);
    peer.truth = std::move(match.truth);
    peer.estimate = std::move(match.estimate);
    for (const std::size_t i : match.matched) peer.sweeps.push_back(run.indices[i]);
  } else {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!poses[i]) continue;
      peer.estimate.push_back(*poses[i]);
      peer.sweeps.push_back(run.indices[i]);
    }
  }
  peer.protocol = {"Compared on", fmt::format("{} of the {} of the run beside it",
                                              counted(peer.estimate.size(), "sweep"), run.results.size())};
  return peer;
}

/// That of the data folder which was given for the truth.
std::optional<SE3> camera_of(const fs::path& truth) {
  const fs::path file = truth / "calib.txt";
  return detail::is_folder(truth) && detail::is_file(file) ? read_kitti_calibration(file) : std::nullopt;
}

/// Without a run: against the given truth, or as they are.
PairedPeer on_their_own(const ReportSequence& sequence, const GivenPoses& given) {
  PoseFile poses = read_poses(given.file);
  if (given.camera_frame) to_lidar_frame(poses, camera_of(sequence.truth));
  if (sequence.truth.empty()) return {poses_of(poses.trajectory), {}, {"Truth", "none was given"}, {}};
  PairingOptions pairing;
  pairing.max_gap_s = given.max_gap_s;
  PairedPoses paired = pair_poses(read_truth(sequence.truth, PoseInstant::kMid), poses, pairing);
  return {std::move(paired.poses.estimate), std::move(paired.poses.truth), {"Protocol", paired.protocol}, {}};
}

Placed placed_poses(const ReportSequence& sequence, const ReportInput& input, const RunRecord* run,
                    const PoseFlags& flags) {
  const GivenPoses given{input.path, flags.camera_frame, flags.max_gap_s};
  const PairedPeer peer = run != nullptr ? on_sweeps_of(*run, sequence, given) : on_their_own(sequence, given);
  if (peer.estimate.empty())
    throw RunError(RunErrorKind::kBadData, input.path.string() + ": no pose of the sweeps compared");
  Placed placed;
  RunReport& report = placed.report;
  report.title = report.name = input.name;
  report.sequence = sequence.name;
  report.dataset = valid_utf8(input.path.string());
  report.facts = {{"Poses", report.dataset}, peer.protocol};
  report.numbers = peer.sweeps;
  report.estimate = moved(peer.estimate, peer.estimate.front().inverse());
  if (!peer.truth.empty()) {
    report.evaluation = evaluate(peer.truth, report.estimate);
    report.truth = moved(peer.truth, peer.truth.front().inverse());
    placed.T_world_odom = peer.truth.front();
  }
  return placed;
}

/// Into the frame of the first run with truth: runs that start later, or poses of another frame, lie where they belong.
void align_frames(std::vector<Placed>& all) {
  const auto reference =
      std::find_if(all.begin(), all.end(), [](const Placed& p) { return p.T_world_odom.has_value(); });
  if (reference == all.end()) return;
  const SE3 T_reference_world = reference->T_world_odom->inverse();
  for (Placed& placed : all) {
    if (!placed.T_world_odom || &placed == &*reference) continue;
    const SE3 T = T_reference_world * *placed.T_world_odom;
    placed.report.estimate = moved(placed.report.estimate, T);
    placed.report.truth = moved(placed.report.truth, T);
    for (Eigen::Vector3f& point : placed.report.map_points) point = T.cast<float>() * point;
  }
}

std::string range_of(const RunRecord& run) {
  return run.indices.empty() ? "none" : fmt::format("{} … {}", run.indices.front(), run.indices.back());
}

void add_notices(const ReportSequence& sequence, const std::vector<Placed>& all, std::vector<std::string>& notices) {
  const std::string where = sequence.name.empty() ? "" : sequence.name + ": ";
  std::string ranges;
  bool differ = false;
  const RunRecord* first = nullptr;
  for (const ReportEntry& entry : sequence.entries) {
    if (!entry.run) continue;
    first = first == nullptr ? &entry.run->record : first;
    differ = differ || range_of(entry.run->record) != range_of(*first);
    ranges += fmt::format("{}{} {}", ranges.empty() ? "" : ", ", entry.input.name, range_of(entry.run->record));
  }
  if (differ) {
    notices.push_back(where + "the runs are over different sweeps (" + ranges +
                      "); their figures are of different stretches of the path.");
  }
  std::string without;
  for (const Placed& placed : all) {
    if (!placed.report.evaluation) without += (without.empty() ? "" : ", ") + placed.report.name;
  }
  const bool mixed =
      std::any_of(all.begin(), all.end(), [](const Placed& p) { return p.report.evaluation.has_value(); });
  if (mixed && !without.empty()) {
    notices.push_back(where + "there is no truth for " + without + ": only the others have curves of errors.");
  }
}

}  // namespace

std::vector<RunReport> reports_of(ReportSequence sequence, const PoseFlags& flags, std::vector<std::string>& notices) {
  const RunRecord* complete = nullptr;
  for (ReportEntry& entry : sequence.entries) {
    if (!entry.run || entry.run->killed) continue;
    evaluate_saved(sequence, flags, *entry.run);
    if (complete == nullptr || (!complete->truth && entry.run->record.truth)) complete = &entry.run->record;
  }
  for (ReportEntry& entry : sequence.entries) {  // of these only the others tell the data
    if (!entry.run || !entry.run->killed) continue;
    if (complete != nullptr) entry.run->record.data = complete->data;
    evaluate_saved(sequence, flags, *entry.run);
  }
  std::vector<Placed> all;
  for (const ReportEntry& entry : sequence.entries) {
    all.push_back(entry.run ? placed_run(sequence, entry) : placed_poses(sequence, entry.input, complete, flags));
  }
  align_frames(all);
  add_notices(sequence, all, notices);
  std::vector<RunReport> reports;
  for (Placed& placed : all) reports.push_back(std::move(placed.report));
  return reports;
}

}  // namespace rilo
