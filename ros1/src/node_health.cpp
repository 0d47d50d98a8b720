#include "node_health.hpp"

#include <algorithm>
#include <diagnostic_msgs/DiagnosticStatus.h>

#include <fmt/format.h>

namespace rilo::ros1 {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;
constexpr std::size_t kStaleReports = 5;

unsigned char level_of(OdometryStatus status) {
  switch (status) {
    case OdometryStatus::kOk:
    case OdometryStatus::kInitialising:
      return Level::OK;
    case OdometryStatus::kLost:
    case OdometryStatus::kEmpty:
      return Level::ERROR;
    default:
      return Level::WARN;
  }
}

}  // namespace

void NodeHealth::note_waiting(const std::string& what) {
  const std::lock_guard lock(mutex_);
  waiting_for_ = what;
}

void NodeHealth::note_sweep(const SweepResult& result, double total_ms) {
  const std::lock_guard lock(mutex_);
  last_ = result;
  ++by_status_.at(static_cast<std::size_t>(result.status));
  ++sweeps_;
  last_ms_ = total_ms;
  sum_ms_ += total_ms;
  most_ms_ = std::max(most_ms_, total_ms);
}

void NodeHealth::note_bad_message(const std::string& why) {
  const std::lock_guard lock(mutex_);
  ++bad_messages_;
  last_bad_message_ = why;
}

void NodeHealth::note_reset() {
  const std::lock_guard lock(mutex_);
  ++resets_;
  last_.reset();
}

void NodeHealth::note_source(const SourceFigures& info) {
  const std::lock_guard lock(mutex_);
  source_ = info;
}

void NodeHealth::report(const LiveQueueCounts& queue, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard lock(mutex_);
  silent_reports_ = queue.received == reported_queue_.received ? silent_reports_ + 1 : 0;
  judge(queue, status);
  add_counts(queue, status);
  reported_queue_ = queue;
  reported_bad_messages_ = bad_messages_;
}

void NodeHealth::judge(const LiveQueueCounts& queue, diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (last_) {
    status.summary(level_of(last_->status), std::string(to_string(last_->status)));
  } else if (sweeps_ > 0) {
    status.summary(Level::OK, "reset, no sweep since");
  } else {
    status.summary(Level::OK, queue.received == 0 ? "no sweep yet" : "looking at the first sweeps");
  }
  if (!waiting_for_.empty()) status.mergeSummary(Level::ERROR, "waiting for " + waiting_for_);
  if (queue.dropped > reported_queue_.dropped) {
    status.mergeSummary(Level::WARN, fmt::format("{} sweeps dropped since the last report: too slow for the sensor",
                                                 queue.dropped - reported_queue_.dropped));
  }
  if (bad_messages_ > reported_bad_messages_) {
    status.mergeSummary(Level::WARN, fmt::format("{} messages that cannot be read since the last report",
                                                 bad_messages_ - reported_bad_messages_));
  }
  if (silent_reports_ >= kStaleReports) {
    status.mergeSummary(Level::STALE, fmt::format("no message for {} reports", silent_reports_));
  }
}

void NodeHealth::add_counts(const LiveQueueCounts& queue, diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("messages received", queue.received);
  status.add("sweeps registered", sweeps_);
  status.add("sweeps dropped", queue.dropped);
  status.add("sweeps waiting", queue.waiting);
  status.add("messages that cannot be read", bad_messages_);
  status.add("last that cannot be read", last_bad_message_);
  status.add("resets", resets_);
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    status.add("status " + std::string(to_string(static_cast<OdometryStatus>(i))), by_status_.at(i));
  }
  status.add("ms of the last sweep", fmt::format("{:.2f}", last_ms_));
  status.add("ms mean", fmt::format("{:.2f}", sweeps_ > 0 ? sum_ms_ / static_cast<double>(sweeps_) : 0));
  status.add("ms largest", fmt::format("{:.2f}", most_ms_));
  status.add("gaps of the stamps", source_.gaps);
  status.add("sweeps missing in the gaps", source_.missing);
  status.add("duplicates left out", source_.duplicates);
  status.add("out of order, left out", source_.out_of_order);
  status.add("jumps back in time", source_.clock_jumps);
  status.add("point times", source_.point_times);
  status.add("lidar frame", source_.lidar_frame);
  if (!last_) return;
  status.add("inlier ratio", fmt::format("{:.3f}", last_->stats.inlier_ratio));
  status.add("least relative eigenvalue", fmt::format("{:.2e}", last_->stats.relative_eigenvalues[0]));
  status.add("map voxels", last_->stats.map_voxels);
}

}  // namespace rilo::ros1
