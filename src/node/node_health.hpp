// What a node reports on /diagnostics.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include "rilo/io/live_queue.hpp"
#include "rilo/node/node_messages.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// What was decided and counted about the sweeps so far (StampFaults, SourceInfo).
struct SourceFigures {
  std::size_t gaps = 0;
  std::size_t missing = 0;
  std::size_t duplicates = 0;
  std::size_t out_of_order = 0;
  std::size_t clock_jumps = 0;
  std::string point_times = "none";
  std::string lidar_frame;
};

/// Counts what happens; any thread.
class NodeHealth {
 public:
  /// What the node is waiting for; empty: nothing but sweeps.
  void note_waiting(const std::string& what);
  void note_sweep(const SweepResult& result);
  void note_bad_message(const std::string& why);
  /// `total` messages did not reach the node, as its transport reports.
  void note_lost(std::size_t total);
  void note_reset();
  void note_source(const SourceFigures& info);

  /// One report: level and sentence of the worst that is the case now or happened since the last report, and all
  /// counts.
  StatusMessage report(const LiveQueueCounts& queue);

 private:
  void judge(const LiveQueueCounts& queue, StatusMessage& status) const;
  void add_counts(const LiveQueueCounts& queue, StatusMessage& status) const;

  mutable std::mutex mutex_;
  std::string waiting_for_;
  std::optional<SweepResult> last_;
  SourceFigures source_;
  std::array<std::size_t, kStatusCount> by_status_{};
  std::size_t sweeps_ = 0;
  std::size_t bad_messages_ = 0;
  std::size_t lost_ = 0;
  std::size_t resets_ = 0;
  std::string last_bad_message_;
  double last_ms_ = 0;
  double sum_ms_ = 0;
  double most_ms_ = 0;
  // At the last report.
  LiveQueueCounts reported_queue_;
  std::size_t reported_bad_messages_ = 0;
  std::size_t reported_sweeps_ = 0;
  std::size_t reported_lost_ = 0;
  std::size_t silent_reports_ = 0;  // without a message
};

}  // namespace rilo
