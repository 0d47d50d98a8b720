// Everything that a page connected now or later is shown.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>

#include "frames.hpp"
#include "sweep_points.hpp"
#include "view/budgeted_map.hpp"
#include "view/viewer.hpp"

namespace rilo::view {

/// Frames of single sweeps within a limit of bytes: beyond it every second one goes, and of those to come, so
/// that the whole run stays there to look back at, evenly. The first and the newest stay.
class SweepStore {
 public:
  explicit SweepStore(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void add(std::uint32_t number, Frame frame);
  /// The same of a sweep between those that are there, or before them.
  void fill(std::uint32_t number, Frame frame);
  /// The last one up to `number`, else the first one; null when there is none.
  Frame at(std::uint32_t number) const;
  Frame newest() const { return frames_.empty() ? nullptr : frames_.rbegin()->second; }
  /// Number of the newest.
  std::uint32_t newest_number() const { return frames_.empty() ? 0 : frames_.rbegin()->first; }
  std::size_t size() const { return frames_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  void thin();

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::size_t seen_ = 0;
  std::size_t every_ = 1;     // one of this many stays
  bool newest_stays_ = true;  // when the next one comes
  std::map<std::uint32_t, Frame> frames_;
};

/// Used by one thread.
class ViewHistory {
 public:
  ViewHistory(const ViewInfo& info, const ViewOptions& options);

  /// Takes a sweep; its points only when there is time for them (ViewOptions::share), and what colours them by residual
  /// only when `watched`.
  void add(const ViewSweep& sweep, bool watched);
  void add_map(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> sweeps);
  void finish();
  /// The points of the sweep added last were dropped on the way.
  void note_dropped();
  /// Sweeps whose points were dropped, ascending: as many as there is room for, evenly over the run. Only these count
  /// as dropped from now on.
  const std::vector<std::uint32_t>& choose_missing();
  /// Adds the points of one of them, however long it takes.
  void fill(std::uint32_t number, const ViewSweep& sweep, bool watched);

  Frame info() const { return info_; }
  const Progress& progress() const { return progress_; }
  std::uint32_t records() const { return progress_.sweeps; }
  /// From `first` on, kRecordsPerFrame at most.
  Frame records_from(std::uint32_t first) const;
  std::uint32_t map_epoch() const { return map_.epoch(); }
  const std::vector<Frame>& map_frames() const { return map_frames_; }
  const SweepStore& sweeps() const { return sweeps_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// `fills`: between the sweeps that are there.
  void add_points(std::uint32_t number, const ViewSweep& sweep, bool watched, bool fills);
  /// Makes frames of the points of the map that are in none yet, once there are so many.
  void cut_map(std::size_t least);

  ViewInfo view_;
  ViewOptions options_;
  Frame info_;
  Progress progress_;
  Bytes records_;
  BudgetedMap map_;
  std::uint32_t framed_epoch_ = 0;
  std::size_t framed_points_ = 0;
  std::vector<Frame> map_frames_;
  SweepStore sweeps_;
  std::vector<std::uint32_t> missing_;  // sweeps whose points were dropped, ascending
  ResidualMap residuals_;
  Clock::time_point next_points_;  // not before
};

}  // namespace rilo::view
