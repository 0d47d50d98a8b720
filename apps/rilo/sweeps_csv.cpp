#include "sweeps_csv.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace rilo::cli {

namespace {

/// Name and value side by side: the header cannot disagree with the lines.
class Row {
 public:
  template <typename Value>
  Row& add(std::string name, const Value& value) {
    cells_.emplace_back(std::move(name), fmt::format("{}", value));
    return *this;
  }

  std::string header() const {
    return joined([](const auto& cell) -> const std::string& { return cell.first; });
  }
  std::string line() const {
    return joined([](const auto& cell) -> const std::string& { return cell.second; });
  }

 private:
  template <typename Part>
  std::string joined(const Part& part) const {
    std::string text;
    for (const auto& cell : cells_) text += (text.empty() ? "" : ",") + part(cell);
    return text + "\n";
  }

  std::vector<std::pair<std::string, std::string>> cells_;
};

void add_uncertainty(Row& row, const SweepResult& result) {
  for (std::size_t i = 0; i < result.stats.relative_eigenvalues.size(); ++i) {
    row.add(fmt::format("eigenvalue_{}", i + 1), result.stats.relative_eigenvalues[i]);
  }
  const std::vector<std::string> axes = {"roll_rad", "pitch_rad", "yaw_rad", "x_m", "y_m", "z_m"};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    row.add("sigma_" + axes[i], std::sqrt(std::max(0.0, result.covariance(k, k))));
  }
}

Row row_of(std::size_t index, const SweepResult& r) {
  const SweepStats& s = r.stats;
  const StageTimes& t = s.times;
  Row row;
  row.add("sweep", index).add("stamp_ns", r.stamp_ns).add("status", to_string(r.status));
  row.add("points_in", s.points_in).add("points_valid", s.points_valid).add("points_map", s.points_map);
  row.add("points_source", s.points_source).add("map_voxels", s.map_voxels);
  row.add("initial_pose", to_string(s.initial_pose)).add("initial_pose_reason", to_string(s.initial_pose_reason));
  row.add("coarse_ran", s.coarse_ran ? 1 : 0).add("coarse_iterations", s.coarse_iterations);
  row.add("pred_align_distance_m", s.pred_align_distance_m);
  row.add("prediction_score", s.prediction_score).add("map_score", s.map_score);
  row.add("iterations", s.iterations).add("converged", s.converged ? 1 : 0);
  row.add("inliers", s.inliers).add("inlier_ratio", s.inlier_ratio).add("residual_rms_m", s.residual_rms_m);
  row.add("sigma_th_m", s.sigma_th_m).add("gamma", s.gamma).add("deviation_m", s.deviation_m);
  row.add("elevation_offset_rad", s.elevation_offset_rad).add("elevation_applied_rad", s.elevation_applied_rad);
  row.add("beam_elevation_rms_rad", s.beam_elevation_rms_rad).add("beam_azimuth_rms_rad", s.beam_azimuth_rms_rad);
  row.add("speed_m_s", r.twist.tail<3>().norm()).add("turn_rate_rad_s", r.twist.head<3>().norm());
  add_uncertainty(row, r);
  row.add("preprocess_ms", t.preprocess_ms).add("initial_pose_ms", t.initial_pose_ms);
  row.add("registration_ms", t.registration_ms).add("map_ms", t.map_ms).add("total_ms", t.total_ms);
  return row;
}

}  // namespace

std::string sweeps_csv(const RunRecord& run) {
  std::string text = row_of(0, SweepResult{}).header();
  for (std::size_t i = 0; i < run.results.size(); ++i) text += row_of(run.indices[i], run.results[i]).line();
  return text;
}

}  // namespace rilo::cli
