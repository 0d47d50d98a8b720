#include "node/node_health.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/text.hpp"

namespace rilo {
namespace {

constexpr std::size_t kStaleReports = 5;
constexpr const char* kByAGuess = ": the poses before and after are connected by a guess";

NodeLevel level_of(OdometryStatus status) {
  switch (status) {
    case OdometryStatus::kOk:
    case OdometryStatus::kInitialising:
      return NodeLevel::kOk;
    case OdometryStatus::kLost:
    case OdometryStatus::kEmpty:
      return NodeLevel::kError;
    default:
      return NodeLevel::kWarn;
  }
}

std::string sentence_of(const SweepResult& result) {
  const std::string status(to_string(result.status));
  const LossCause cause = result.stats.loss_cause;
  return cause == LossCause::kNone ? status : fmt::format("{} ({})", status, to_string(cause));
}

// The worst counts; all that is wrong is listed.
void merge(NodeLevel level, const std::string& message, StatusMessage& status) {
  const bool was_well = status.level == NodeLevel::kOk;
  status.message = was_well ? message : status.message + "; " + message;
  status.level = std::max(status.level, level);
}

}  // namespace

void NodeHealth::note_waiting(const std::string& what) {
  const std::lock_guard lock(mutex_);
  waiting_for_ = what;
}

NodeHealth::News NodeHealth::note_sweep(const SweepResult& result) {
  const std::lock_guard lock(mutex_);
  News news;
  if (result.status == OdometryStatus::kLost && (!last_ || last_->status != OdometryStatus::kLost)) {
    news.lost = sentence_of(result);
  }
  if (result.status == OdometryStatus::kInitialising && maps_++ > 0) {
    ++fresh_maps_;
    news.new_map = std::string("a new map begins") + kByAGuess;
  }
  last_ = result;
  if (!worst_ || level_of(result.status) > level_of(worst_->status)) worst_ = result;
  ++by_status_.at(static_cast<std::size_t>(result.status));
  ++sweeps_;
  last_ms_ = result.stats.times.total_ms;
  sum_ms_ += last_ms_;
  most_ms_ = std::max(most_ms_, last_ms_);
  return news;
}

void NodeHealth::note_end(double ms, std::size_t map_points, bool map_is_full) {
  const std::lock_guard lock(mutex_);
  most_busy_ms_ = std::max(most_busy_ms_, ms);
  map_points_ = map_points;
  map_is_full_ = map_is_full;
}

std::size_t NodeHealth::new_maps() const {
  const std::lock_guard lock(mutex_);
  return maps_ > 0 ? maps_ - 1 : 0;
}

void NodeHealth::note_bad_message(const std::string& why) {
  const std::lock_guard lock(mutex_);
  ++bad_messages_;
  last_bad_message_ = why;
}

void NodeHealth::note_lost(std::size_t total) {
  const std::lock_guard lock(mutex_);
  lost_ = total;
}

void NodeHealth::note_reset() {
  const std::lock_guard lock(mutex_);
  ++resets_;
  last_.reset();
  worst_.reset();
  maps_ = fresh_maps_ = 0;
}

void NodeHealth::note_source(const SourceFigures& info) {
  const std::lock_guard lock(mutex_);
  source_ = info;
}

StatusMessage NodeHealth::report(const LiveQueueCounts& queue) {
  const std::lock_guard lock(mutex_);
  StatusMessage status;
  // Messages of another type are counted as bad and are in no queue.
  const bool silent = queue.received == reported_queue_.received && bad_messages_ == reported_bad_messages_;
  silent_reports_ = silent ? silent_reports_ + 1 : 0;
  judge(queue, status);
  add_counts(queue, status);
  reported_queue_ = queue;
  reported_bad_messages_ = bad_messages_;
  reported_sweeps_ = sweeps_;
  reported_lost_ = lost_;
  worst_.reset();
  fresh_maps_ = 0;
  most_ms_ = most_busy_ms_ = 0;
  return status;
}

void NodeHealth::judge_sweeps(StatusMessage& status) const {
  status.level = level_of(last_->status);
  status.message = sentence_of(*last_);
  if (worst_ && level_of(worst_->status) > status.level) {
    merge(level_of(worst_->status), sentence_of(*worst_) + " since the last report", status);
  }
  if (fresh_maps_ > 0) {
    merge(NodeLevel::kError, detail::counted(fresh_maps_, "new map") + " began" + kByAGuess, status);
  }
  if (map_is_full_) merge(NodeLevel::kWarn, "the map for save_map has map_points points: it takes no more", status);
}

void NodeHealth::judge(const LiveQueueCounts& queue, StatusMessage& status) const {
  if (last_) {
    judge_sweeps(status);
  } else if (sweeps_ > 0) {
    status.message = "reset, no sweep since";
  } else {
    status.message = queue.received == 0 ? "no sweep yet" : "looking at the first sweeps";
  }
  if (!waiting_for_.empty()) merge(NodeLevel::kError, "waiting for " + waiting_for_, status);
  if (queue.dropped > reported_queue_.dropped) {
    const std::size_t dropped = queue.dropped - reported_queue_.dropped;
    merge(NodeLevel::kWarn,
          detail::counted(dropped, "sweep") + " dropped since the last report: too slow for the sensor", status);
  }
  if (lost_ > reported_lost_) {
    merge(NodeLevel::kWarn,
          detail::counted(lost_ - reported_lost_, "message") + " lost on the way since the last report", status);
  }
  if (bad_messages_ > reported_bad_messages_) {
    const std::size_t bad = bad_messages_ - reported_bad_messages_;
    const bool none = sweeps_ == reported_sweeps_;
    merge(none ? NodeLevel::kError : NodeLevel::kWarn,
          fmt::format("{} that cannot be read since the last report{}", detail::counted(bad, "message"),
                      none ? ", and no other" : ""),
          status);
  }
  if (silent_reports_ >= kStaleReports) {
    merge(NodeLevel::kStale, fmt::format("no message for {} reports", silent_reports_), status);
  }
}

void NodeHealth::add_counts(const LiveQueueCounts& queue, StatusMessage& status) const {
  const auto add = [&](std::string key, const auto& value) {
    status.values.emplace_back(std::move(key), fmt::format("{}", value));
  };
  add("messages received", queue.received);
  add("messages lost on the way", lost_);
  add("sweeps registered", sweeps_);
  add("sweeps dropped", queue.dropped);
  add("sweeps waiting", queue.waiting);
  add("messages that cannot be read", bad_messages_);
  add("last that cannot be read", last_bad_message_);
  add("resets", resets_);
  add("new maps", maps_ > 0 ? maps_ - 1 : 0);
  add("points of the map for save_map", map_points_);
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    add("status " + std::string(to_string(static_cast<OdometryStatus>(i))), by_status_.at(i));
  }
  const auto add_rounded = [&](const char* key, double value) { add(key, fmt::format("{:.2f}", value)); };
  add_rounded("ms of the last sweep", last_ms_);
  add_rounded("ms mean", sweeps_ > 0 ? sum_ms_ / static_cast<double>(sweeps_) : 0);
  add_rounded("ms largest", most_ms_);
  add_rounded("ms largest with publishing", most_busy_ms_);
  add("gaps of the stamps", source_.gaps);
  add("sweeps missing in the gaps", source_.missing);
  add("duplicates dropped", source_.duplicates);
  add("out of order, dropped", source_.out_of_order);
  add("jumps back in time", source_.clock_jumps);
  add("point times", source_.point_times);
  add("lidar frame", source_.lidar_frame);
  if (!last_) return;
  add("inlier ratio", fmt::format("{:.3f}", last_->stats.inlier_ratio));
  add("least relative eigenvalue", fmt::format("{:.2e}", last_->stats.relative_eigenvalues[0]));
  add("map voxels", last_->stats.map_voxels);
}

}  // namespace rilo
