#include "view_history.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace rilo::view {

namespace {

constexpr double kMapVoxelM = 0.2;
constexpr double kMapRangeM = 70.0;  // farther points are few and far between: noise in the picture
constexpr std::size_t kRecordsPerFrame = 2048;
constexpr std::size_t kMapPointsPerFrame = 16384;
constexpr std::size_t kUsualFrameBytes = 150'000;  // of a sweep, before there is one
constexpr std::size_t kLeastMapPoints = 1500;      // of a frame, as long as more will come

template <typename Enum>
std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) all.emplace_back(to_string(static_cast<Enum>(i)));
  return all;
}

std::string info_json(const ViewInfo& info, const ViewOptions& options) {
  nlohmann::json json = {{"title", info.title},
                         {"data", info.data},
                         {"live", info.live},
                         {"points", info.points},
                         {"note", info.note},
                         {"degenerate_ratio", info.degenerate_ratio},
                         {"map_points", options.map_points},
                         {"status", names<OdometryStatus>(kStatusCount)},
                         {"initial_pose", names<InitialPoseSource>(3)},
                         {"initial_pose_reason", names<InitialPoseReason>(8)}};
  json["sweeps"] = info.sweeps ? nlohmann::json(*info.sweeps) : nlohmann::json(nullptr);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool has_place(OdometryStatus status) { return status != OdometryStatus::kLost && status != OdometryStatus::kEmpty; }

}  // namespace

void SweepStore::add(std::uint32_t number, Frame frame) {
  if (!newest_stays_) {
    bytes_ -= frames_.rbegin()->second->size();
    frames_.erase(std::prev(frames_.end()));
  }
  bytes_ += frame->size();
  frames_.insert_or_assign(number, std::move(frame));
  if (bytes_ > max_bytes_ && frames_.size() > 2) thin();
  newest_stays_ = seen_++ % every_ == 0;
}

void SweepStore::fill(std::uint32_t number, Frame frame) {
  bytes_ += frame->size();
  frames_.emplace(number, std::move(frame));
  if (bytes_ > max_bytes_ && frames_.size() > 2) thin();
}

Frame SweepStore::at(std::uint32_t number) const {
  if (frames_.empty()) return nullptr;
  auto after = frames_.upper_bound(number);
  if (after != frames_.begin()) --after;
  return after->second;
}

void SweepStore::thin() {
  every_ *= 2;
  bool goes = false;
  for (auto frame = frames_.begin(); frame != std::prev(frames_.end());) {
    if (goes) bytes_ -= frame->second->size();
    frame = goes ? frames_.erase(frame) : std::next(frame);
    goes = !goes;
  }
}

ViewHistory::ViewHistory(const ViewInfo& info, const ViewOptions& options)
    : view_(info),
      options_(options),
      info_(info_frame(info_json(info, options))),
      map_(kMapVoxelM, options.map_points),
      sweeps_(options.sweep_bytes) {
  progress_.total = static_cast<std::uint32_t>(info.sweeps.value_or(0));
}

void ViewHistory::add(const ViewSweep& sweep, bool watched) {
  append_record(sweep, records_);
  ++progress_.sweeps;
  if (sweep.sweep.points.empty()) return;
  const Clock::time_point begin = Clock::now();
  if (begin < next_points_) {
    note_dropped();
    return;
  }
  add_points(progress_.sweeps - 1, sweep, watched, false);
  // What this took is paid back with idle time.
  const Clock::duration spent = Clock::now() - begin;
  const double idle = 1.0 / std::clamp(options_.share, 0.001, 1.0) - 1.0;
  next_points_ = begin + spent + std::chrono::duration_cast<Clock::duration>(spent * idle);
}

void ViewHistory::note_dropped() {
  missing_.push_back(progress_.sweeps - 1);
  progress_.dropped = static_cast<std::uint32_t>(missing_.size());
}

const std::vector<std::uint32_t>& ViewHistory::choose_missing() {
  const std::size_t frame_bytes = sweeps_.size() > 0 ? sweeps_.bytes() / sweeps_.size() : kUsualFrameBytes;
  const std::size_t all_bytes = progress_.sweeps * std::max<std::size_t>(frame_bytes, 1);
  const std::size_t every = all_bytes / std::max<std::size_t>(options_.sweep_bytes, 1) + 1;
  std::erase_if(missing_, [&](std::uint32_t number) { return number % every != 0; });
  progress_.dropped = static_cast<std::uint32_t>(missing_.size());
  return missing_;
}

void ViewHistory::fill(std::uint32_t number, const ViewSweep& sweep, bool watched) {
  const auto place = std::lower_bound(missing_.begin(), missing_.end(), number);
  if (place == missing_.end() || *place != number) return;
  missing_.erase(place);
  progress_.dropped = static_cast<std::uint32_t>(missing_.size());
  add_points(number, sweep, watched, true);
}

void ViewHistory::add_points(std::uint32_t number, const ViewSweep& sweep, bool watched, bool fills) {
  SweepPoints points =
      sample_sweep(sweep, options_.sweep_points, view_.min_range_m, view_.max_range_m, std::size_t{number} * 3);
  const SE3& T = sweep.result.T_odom_lidar;
  if (watched) residuals_.measure(T, points);
  Frame frame = sweep_frame(number, points);
  if (fills) {
    sweeps_.fill(number, std::move(frame));
  } else {
    sweeps_.add(number, std::move(frame));
  }
  if (!has_place(sweep.result.status)) return;
  if (watched) residuals_.add(T, points);
  std::vector<Eigen::Vector3f> world;
  world.reserve(points.points.size());
  for (const Eigen::Vector3f& p : points.points) {
    if (static_cast<double>(p.norm()) < kMapRangeM) world.push_back((T * p.cast<double>()).cast<float>());
  }
  map_.add(world, number);
  cut_map(kLeastMapPoints);
}

void ViewHistory::add_map(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> sweeps) {
  for (std::size_t i = 0; i < std::min(points.size(), sweeps.size()); ++i) map_.add(points.subspan(i, 1), sweeps[i]);
  cut_map(1);
}

void ViewHistory::finish() {
  progress_.finished = true;
  cut_map(1);
}

Frame ViewHistory::records_from(std::uint32_t first) const {
  const std::size_t count = std::min<std::size_t>(progress_.sweeps - first, kRecordsPerFrame);
  return records_frame(first, std::span(records_).subspan(first * kRecordBytes, count * kRecordBytes));
}

void ViewHistory::cut_map(std::size_t least) {
  if (framed_epoch_ != map_.epoch()) {
    framed_epoch_ = map_.epoch();
    framed_points_ = 0;
    map_frames_.clear();
  }
  const std::span<const MapPoint> all = map_.points();
  while (all.size() - framed_points_ >= least) {
    // A frame counts sweeps with 16 bits.
    const auto rest = all.subspan(framed_points_, std::min(all.size() - framed_points_, kMapPointsPerFrame));
    const auto far = std::find_if(rest.begin(), rest.end(), [&](const MapPoint& point) {
      return point.sweep < rest.front().sweep || point.sweep - rest.front().sweep > 60000U;
    });
    const auto part = rest.first(static_cast<std::size_t>(far - rest.begin()));
    map_frames_.push_back(map_frame(part, map_.voxel_m(), map_frames_.empty()));
    framed_points_ += part.size();
  }
}

}  // namespace rilo::view
