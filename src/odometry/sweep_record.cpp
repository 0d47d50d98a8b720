#include "odometry/sweep_record.hpp"

namespace rilo {

void record(const SweepView& sweep, const PreparedSweep& prepared, SweepStats& stats) {
  stats.points_in = sweep.points.size();
  stats.points_valid = prepared.valid_points;
  stats.points_isolated = prepared.flakes;
  stats.points_map = prepared.map_cloud.size();
  stats.points_source = prepared.source.size();
}

void record(const InitialPose& init, SweepStats& stats) {
  stats.initial_pose = init.source;
  stats.initial_pose_reason = init.reason;
  stats.coarse_ran = init.coarse_starts > 0;
  stats.coarse_cut = init.coarse_cut;
  stats.coarse_iterations = init.coarse_iterations;
  stats.pred_align_distance_m = init.pred_align_distance_m;
  stats.prediction_score = init.prediction_score;
}

void record(const IcpResult& icp, SweepStats& stats) {
  stats.iterations = icp.iterations;
  stats.converged = icp.converged();
  stats.inliers = icp.inliers;
  stats.inlier_ratio = static_cast<double>(icp.inliers) / static_cast<double>(stats.points_source);
  stats.residual_rms_m = icp.residual_rms_m;
  for (std::size_t i = 0; i < stats.relative_eigenvalues.size(); ++i) {
    stats.relative_eigenvalues[i] = icp.degeneracy.relative_eigenvalues[static_cast<Eigen::Index>(i)];
  }
}

void record(const SensorCalibration& calibration, SweepStats& stats) {
  const ElevationOffsetEstimator& elevation = calibration.elevation();
  const AngleEstimate estimate = elevation.estimate();
  stats.elevation_offset_rad = estimate.rad;
  stats.elevation_offset_sigma_rad = estimate.sigma_rad;
  stats.elevation_applied_rad = elevation.applied_rad();
  const Eigen::Vector2d beams_rad = calibration.beams().rms_rad();
  stats.beam_elevation_rms_rad = beams_rad.x();
  stats.beam_azimuth_rms_rad = beams_rad.y();
}

}  // namespace rilo
