#include "results/live_view.hpp"

#include <iostream>
#include <limits>
#include <unordered_map>
#include <utility>

#include "console/interrupt.hpp"
#include "console/text.hpp"
#include "geometry/voxel_key.hpp"
#include "io/folders/ground_truth.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

// Prints the address on standard error, even in a quiet run: it cannot be found otherwise.
std::unique_ptr<Viewer> announced_viewer(const ViewInfo& info, const ViewOptions& options) {
  try {
    auto viewer = open_viewer(info, options);
    std::cerr << "rilo: viewer at " << viewer->url() << '\n' << std::flush;
    return viewer;
  } catch (const IoError& error) {
    throw RunError(RunErrorKind::kUsage, error.what());
  }
}

constexpr double kNearM = 30.0;  // of a point of the map
constexpr double kPoseStepM = 2.0;
constexpr double kCellM = 5.0;
constexpr float kFarthestM = 1e9F;

using Place = std::pair<Eigen::Vector3f, std::uint32_t>;  // of the sensor, and its sweep

std::uint32_t first_near(const Eigen::Vector3f& point, const std::vector<Place>& places) {
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
  return sweep;
}

}  // namespace

TruthTrack::TruthTrack(const std::filesystem::path& data) {
  try {
    auto truth = read_ground_truth(data, PoseInstant::kMid);
    if (truth) T_world_lidar_ = std::move(truth->T_world_lidar);
  } catch (const IoError&) {
    // The run itself reports what is wrong with it.
    T_world_lidar_.clear();
  }
}

std::optional<Eigen::Vector3d> TruthTrack::at(std::size_t index, const SE3& estimate) {
  if (index >= T_world_lidar_.size()) return std::nullopt;
  if (!T_odom_world_) T_odom_world_ = estimate * T_world_lidar_[index].inverse();
  return (*T_odom_world_ * T_world_lidar_[index]).translation();
}

LiveView::LiveView(const ViewInfo& info, const ViewOptions& options, std::optional<TruthTrack> truth)
    : live_(info.live), truth_(std::move(truth)), viewer_(announced_viewer(info, options)) {}

LiveView::~LiveView() {
  const std::string why = viewer_->failure();
  if (!why.empty()) std::cerr << "rilo: the viewer ended early: " << why << '\n';
}

void LiveView::show(std::size_t index, const SweepResult& result, Sweep sweep) {
  ViewSweep view;
  view.index = index;
  view.result = result;
  if (truth_) view.truth = truth_->at(index, result.T_odom_lidar);
  view.full_covariance = live_;
  view.sweep = std::move(sweep);
  viewer_->push(std::move(view), !live_);
}

void LiveView::show_missing(ScanSource& source, const RunRecord& run) {
  for (const std::uint32_t number : viewer_->missing_points()) {
    if (number >= run.indices.size()) break;
    std::optional<Sweep> sweep;
    do {
      if (InterruptGuard::signal() != 0) return;
      sweep = source.next();
    } while (sweep && source.current_index() < run.indices[number]);
    if (!sweep) return;
    if (source.current_index() != run.indices[number]) continue;
    ViewSweep view;
    view.index = run.indices[number];
    view.result = run.results[number];
    view.sweep = std::move(*sweep);
    viewer_->fill(number, std::move(view));
  }
}

void LiveView::start_over() {
  if (truth_) truth_->start_over();
  viewer_->start_over();
}

ViewInfo view_info(const std::string& data, const OdometryConfig& config) {
  ViewInfo info;
  info.title = valid_utf8(last_name(data));
  info.data = valid_utf8(data);
  info.degenerate_ratio = config.health.degenerate_ratio;
  info.min_range_m = config.preprocess.min_range_m;
  info.max_range_m = config.preprocess.max_range_m;
  return info;
}

std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results) {
  std::vector<Place> places;  // every few metres
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Eigen::Vector3f place = results[i].T_odom_lidar.translation().cast<float>();
    if (!places.empty() && (place - places.back().first).norm() < static_cast<float>(kPoseStepM)) continue;
    places.emplace_back(place, static_cast<std::uint32_t>(i));
  }
  // One look at all places for a cell of the map: there may be millions of points.
  std::unordered_map<std::uint64_t, std::uint32_t> by_cell;
  std::vector<std::uint32_t> seen;
  seen.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    if (!(point.squaredNorm() < kFarthestM * kFarthestM)) {  // of a damaged file: it has no cell
      seen.push_back(first_near(point, places));
      continue;
    }
    const auto [cell, is_new] = by_cell.try_emplace(voxel_key(voxel_of(point, 1.0 / kCellM)));
    if (is_new) cell->second = first_near(point, places);
    seen.push_back(cell->second);
  }
  return seen;
}

}  // namespace rilo
