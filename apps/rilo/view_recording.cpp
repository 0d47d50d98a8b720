#include "view_recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_reader.hpp"

namespace rilo::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRemedy = "Give a folder that rilo run --out has written";
constexpr double kNearM = 30.0;  // of a point of the map
constexpr double kPoseStepM = 2.0;

/// A line of sweeps.csv with the names of its cells.
class CsvRow {
 public:
  CsvRow(const fs::path& file, std::size_t line, const std::map<std::string, std::size_t>& columns,
         std::vector<std::string> cells)
      : file_(file), line_(line), columns_(columns), cells_(std::move(cells)) {}

  const std::string& text(const std::string& name) const {
    const auto column = columns_.find(name);
    if (column == columns_.end())
      throw IoError({file_, "line 1", "no column " + name, "the columns of rilo run", kRemedy});
    return cells_[column->second];
  }

  template <typename Number>
  Number number(const std::string& name) const {
    const std::string& cell = text(name);
    Number value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size()) fail(name, "a number");
    return value;
  }

  /// One of `count` names of an enumeration.
  template <typename Enum>
  Enum word(const std::string& name, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (to_string(static_cast<Enum>(i)) == text(name)) return static_cast<Enum>(i);
    }
    fail(name, "one of its words");
  }

 private:
  [[noreturn]] void fail(const std::string& name, const std::string& expected) const {
    throw IoError({file_, fmt::format("line {}, column {}", line_, name), "'" + text(name) + "'", expected, kRemedy});
  }

  const fs::path& file_;
  std::size_t line_;
  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string> cells_;
};

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

void read_times(const CsvRow& row, StageTimes& times) {
  times.preprocess_ms = row.number<double>("preprocess_ms");
  times.initial_pose_ms = row.number<double>("initial_pose_ms");
  times.registration_ms = row.number<double>("registration_ms");
  times.map_ms = row.number<double>("map_ms");
  times.total_ms = row.number<double>("total_ms");
}

void read_stats(const CsvRow& row, SweepStats& stats) {
  stats.points_in = row.number<std::size_t>("points_in");
  stats.map_voxels = row.number<std::size_t>("map_voxels");
  stats.initial_pose = row.word<InitialPoseSource>("initial_pose", 3);
  stats.initial_pose_reason = row.word<InitialPoseReason>("initial_pose_reason", 8);
  stats.coarse_ran = row.number<int>("coarse_ran") != 0;
  stats.coarse_iterations = row.number<int>("coarse_iterations");
  stats.pred_align_distance_m = row.number<double>("pred_align_distance_m");
  stats.prediction_score = row.number<double>("prediction_score");
  stats.map_score = row.number<double>("map_score");
  stats.iterations = row.number<int>("iterations");
  stats.converged = row.number<int>("converged") != 0;
  stats.inliers = row.number<std::size_t>("inliers");
  stats.inlier_ratio = row.number<double>("inlier_ratio");
  stats.residual_rms_m = row.number<double>("residual_rms_m");
  stats.sigma_th_m = row.number<double>("sigma_th_m");
  for (std::size_t i = 0; i < stats.relative_eigenvalues.size(); ++i) {
    stats.relative_eigenvalues[i] = row.number<double>(fmt::format("eigenvalue_{}", i + 1));
  }
  read_times(row, stats.times);
}

SweepResult result_of(const CsvRow& row) {
  SweepResult result;
  result.stamp_ns = row.number<std::int64_t>("stamp_ns");
  result.status = row.word<OdometryStatus>("status", kStatusCount);
  read_stats(row, result.stats);
  const std::vector<std::string> axes = {"roll_rad", "pitch_rad", "yaw_rad", "x_m", "y_m", "z_m"};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    result.covariance(k, k) = std::pow(row.number<double>("sigma_" + axes[i]), 2);
  }
  return result;
}

void read_sweeps(const fs::path& file, RecordedRun& run) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw IoError({file, "", "nothing that can be read", "a line a sweep", kRemedy});
  std::map<std::string, std::size_t> columns;
  for (const std::string& name : csv_cells(line)) columns.emplace(name, columns.size());
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != columns.size()) {
      throw IoError({file, fmt::format("line {}", number), fmt::format("{} values", cells.size()),
                     fmt::format("{}", columns.size()), kRemedy});
    }
    const CsvRow row(file, number, columns, std::move(cells));
    run.indices.push_back(row.number<std::size_t>("sweep"));
    run.results.push_back(result_of(row));
  }
}

void add_twists(std::vector<SweepResult>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SweepResult& before = results[i == 0 ? 0 : i - 1];
    const SweepResult& after = results[std::min(i + 1, results.size() - 1)];
    const double dt_s = static_cast<double>(after.stamp_ns - before.stamp_ns) * 1e-9;
    if (dt_s > 0.0) results[i].twist = se3_log(before.T_odom_lidar.inverse() * after.T_odom_lidar) / dt_s;
  }
}

nlohmann::json json_of(const fs::path& file) {
  std::ifstream stream(file);
  nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) throw IoError({file, "", "no JSON object", "the figures of a run", kRemedy});
  return json;
}

}  // namespace

RecordedRun read_recorded_run(const fs::path& folder) {
  RecordedRun run;
  run.metrics = json_of(folder / "metrics.json");
  read_sweeps(folder / "sweeps.csv", run);
  const fs::path poses = folder / "trajectory.tum";
  const Trajectory trajectory = read_tum(poses);
  if (trajectory.size() != run.results.size()) {
    throw IoError({poses, "", fmt::format("{} poses", trajectory.size()),
                   fmt::format("{}, as many as sweeps.csv has lines", run.results.size()), kRemedy});
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) run.results[i].T_odom_lidar = trajectory[i].T_odom_lidar;
  add_twists(run.results);
  return run;
}

std::optional<fs::path> recorded_map(const fs::path& folder) {
  std::optional<fs::path> map;
  std::uintmax_t largest = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path extension = entry.path().extension();
    if ((extension != ".ply" && extension != ".pcd") || !entry.is_regular_file(ignored)) continue;
    if (!map || entry.file_size(ignored) > largest) {
      map = entry.path();
      largest = entry.file_size(ignored);
    }
  }
  return map;
}

std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results) {
  std::vector<std::pair<Eigen::Vector3f, std::uint32_t>> places;  // every few metres
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Eigen::Vector3f place = results[i].T_odom_lidar.translation().cast<float>();
    if (!places.empty() && (place - places.back().first).norm() < static_cast<float>(kPoseStepM)) continue;
    places.emplace_back(place, static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> seen;
  seen.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    float nearest = std::numeric_limits<float>::max();
    std::uint32_t sweep = 0;
    for (const auto& [place, number] : places) {
      const float distance = (place - point).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        sweep = number;
      }
      if (distance < static_cast<float>(kNearM * kNearM)) break;
    }
    seen.push_back(sweep);
  }
  return seen;
}

}  // namespace rilo::cli
