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
  /// What is to be told at once, in a sentence each; empty: nothing.
  struct News {
    std::string lost;     ///< the first lost sweep after others
    std::string new_map;  ///< another one than the first since the start or the last reset
  };
  News note_sweep(const SweepResult& result);
  /// After a sweep: `ms` from its beginning until all of it was published, and the map kept for save_map.
  void note_end(double ms, std::size_t map_points, bool map_is_full);
  void note_bad_message(const std::string& why);
  /// `total` messages did not reach the node, as its transport reports.
  void note_lost(std::size_t total);
  void note_reset();
  void note_source(const SourceFigures& info);

  /// Maps begun since the start or the last reset but for the first: poses before and after are connected by a guess.
  std::size_t new_maps() const;

  /// One report: level and sentence of the worst that is the case now or happened since the last report, and all
  /// counts.
  StatusMessage report(const LiveQueueCounts& queue);

 private:
  void judge(const LiveQueueCounts& queue, StatusMessage& status) const;
  void judge_sweeps(StatusMessage& status) const;
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
  std::size_t maps_ = 0;  // begun since the start or the last reset
  std::size_t map_points_ = 0;
  bool map_is_full_ = false;
  // Since the last report.
  std::optional<SweepResult> worst_;
  std::size_t fresh_maps_ = 0;  // but for the first
  double most_ms_ = 0;
  double most_busy_ms_ = 0;
  // At the last report.
  LiveQueueCounts reported_queue_;
  std::size_t reported_bad_messages_ = 0;
  std::size_t reported_sweeps_ = 0;
  std::size_t reported_lost_ = 0;
  std::size_t silent_reports_ = 0;  // without a message
};

}  // namespace rilo
