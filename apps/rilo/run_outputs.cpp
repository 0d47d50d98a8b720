// The files that a run leaves behind.
#include <sstream>

#include <fmt/format.h>

#include "command.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/evaluation/alignment.hpp"
#include "rilo/io/atomic_file.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_writer.hpp"
#include "rilo/report/html_report.hpp"
#include "run_record.hpp"

namespace rilo::cli {

namespace {

std::string csv_line(std::size_t index, const SweepResult& r) {
  const SweepStats& s = r.stats;
  std::string line =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", index, r.stamp_ns,
                  to_string(r.status), s.points_in, s.points_valid, s.points_map, s.points_source, s.map_voxels,
                  to_string(s.initial_pose), to_string(s.initial_pose_reason), s.coarse_ran ? 1 : 0,
                  s.coarse_iterations, s.pred_align_distance_m, s.prediction_score, s.map_score, s.iterations,
                  s.converged ? 1 : 0, s.inliers, s.inlier_ratio, s.residual_rms_m, s.sigma_th_m, s.gamma,
                  s.deviation_m, r.twist.tail<3>().norm(), r.twist.head<3>().norm());
  for (const double eigenvalue : s.relative_eigenvalues) {
    line += fmt::format(",{}", eigenvalue);
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    line += fmt::format(",{}", std::sqrt(std::max(0.0, r.covariance(i, i))));
  }
  const StageTimes& t = s.times;
  return line +
         fmt::format(",{},{},{},{},{}\n", t.preprocess_ms, t.initial_pose_ms, t.registration_ms, t.map_ms, t.total_ms);
}

constexpr const char* kCsvHeader =
    "sweep,stamp_ns,status,points_in,points_valid,points_map,points_source,map_voxels,initial_pose,initial_pose_reason,"
    "coarse_ran,"
    "coarse_iterations,pred_align_distance_m,prediction_score,map_score,iterations,converged,inliers,inlier_ratio,"
    "residual_rms_m,"
    "sigma_th_m,gamma,deviation_m,speed_m_s,turn_rate_rad_s,eigenvalue_1,eigenvalue_2,eigenvalue_3,eigenvalue_4,"
    "eigenvalue_5,"
    "eigenvalue_6,sigma_roll_rad,sigma_pitch_rad,sigma_yaw_rad,sigma_x_m,sigma_y_m,sigma_z_m,preprocess_ms,initial_"
    "pose_ms,"
    "registration_ms,map_ms,total_ms\n";

std::string sweeps_csv(const RunRecord& run) {
  std::string text = kCsvHeader;
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    text += csv_line(run.indices[i], run.results[i]);
  }
  return text;
}

ReportSweep report_sweep(const SweepResult& result) {
  const SweepStats& s = result.stats;
  ReportSweep sweep;
  sweep.total_ms = s.times.total_ms;
  sweep.preprocess_ms = s.times.preprocess_ms;
  sweep.coarse_ms = s.times.initial_pose_ms;
  sweep.registration_ms = s.times.registration_ms;
  sweep.map_ms = s.times.map_ms;
  sweep.iterations = s.iterations;
  sweep.inlier_ratio = s.inlier_ratio;
  sweep.sigma_th_m = s.sigma_th_m;
  sweep.status = to_string(result.status);
  sweep.initial_pose = to_string(s.initial_pose);
  return sweep;
}

RunReport report_of(const RunRecord& run, const nlohmann::json& metrics) {
  RunReport report;
  report.title = "Rilo: " + run.data.filename().string();
  report.dataset = run.data.string();
  if (run.signal != 0) {
    report.notice = "The run was interrupted: this is the part before.";
  } else if (!run.error.empty()) {
    report.notice = "The run ended at an error in the data: " + run.error;
  }
  report.facts = {{"Command", run.command_line},
                  {"Rilo", metrics["rilo_version"].get<std::string>()},
                  {"Format", metrics["format"].get<std::string>()},
                  {"Threads", std::to_string(run.threads)},
                  {"Pose instant", std::string(to_string(run.pose_instant)) + " of the sweep"},
                  {"Point times", run.source.point_times},
                  {"Motion compensation", metrics["motion_compensation"].get<bool>() ? "on" : "off (no point times)"},
                  {"Elevation correction", fmt::format("{} deg", run.source.elevation_correction_deg)},
                  {"Time measured", metrics["ms_note"].get<std::string>()}};
  if (run.truth) {
    report.facts.emplace_back("Ground truth", run.truth->file + " (" + run.truth->instant + ")");
  }
  for (const SweepResult& result : run.results) {
    report.estimate.push_back(result.T_odom_lidar);
    report.sweeps.push_back(report_sweep(result));
  }
  if (run.truth && run.truth->truth.size() >= 2) {
    const SE3 T = run.truth->estimate.front() * run.truth->truth.front().inverse();
    report.truth = moved(run.truth->truth, T);
  }
  report.evaluation = run.evaluation;
  report.map_points = run.map;
  report.sweep_period_ms = run.source.period_s * 1e3;
  report.peak_rss_mb = metrics["peak_rss_mb"].get<double>();
  return report;
}

}  // namespace

void prepare_output(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw CommandError(kCannotWrite, folder.string() + ": cannot be created (" +
                                         (error ? error.message() : "it is not a folder") + "); choose another --out");
  }
  try {
    const AtomicFile probe(folder / "metrics.json");
  } catch (const IoError& problem) {
    throw CommandError(kCannotWrite, problem.what());
  }
}

void write_outputs(const RunRecord& run, const nlohmann::json& metrics, const std::filesystem::path& folder,
                   bool with_report) {
  Trajectory trajectory;
  for (const SweepResult& result : run.results) {
    trajectory.push_back({result.stamp_ns, result.T_odom_lidar});
  }
  try {
    write_kitti_poses(folder / "poses_lidar.txt", trajectory);
    if (run.source.T_cam_lidar) {
      write_kitti_poses_camera(folder / "poses_camera.txt", trajectory, *run.source.T_cam_lidar);
    }
    write_tum(folder / "trajectory.tum", trajectory);
    write_atomically(folder / "config.yaml", dump_config(run.config));
    write_atomically(folder / "sweeps.csv", sweeps_csv(run));
    write_atomically(folder / "metrics.json", metrics.dump(2) + "\n");
    if (with_report && !run.results.empty()) {
      std::ostringstream html;
      write_html_report(report_of(run, metrics), html);
      write_atomically(folder / "report.html", html.str());
    }
  } catch (const IoError& error) {
    throw CommandError(kCannotWrite, error.what());
  }
}

}  // namespace rilo::cli
