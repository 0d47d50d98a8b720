// What `rilo run` and `rilo bench` do beside the odometry during a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "console/progress.hpp"
#include "results/live_view.hpp"
#include "results/run_request.hpp"
#include "rilo/session/session.hpp"
#include "view/budgeted_map.hpp"

namespace rilo {

/// Refuses sweeps without what the flags need of them.
class SweepCheck final : public SessionObserver {
 public:
  explicit SweepCheck(const RunRequest& flags) : flags_(flags) {}
  /// @throws RunError, kBadData
  void on_read(const Sweep& sweep, const std::string& name) override;

 private:
  const RunRequest& flags_;
};

/// The bar, warnings, and the line that reports a restart.
class ProgressLine final : public SessionObserver {
 public:
  ProgressLine(const RunRequest& flags, const ScanSource& source);
  void on_read(const Sweep& sweep, const std::string& name) override;
  void on_registered(const RegisteredSweep& sweep) override;
  void on_trial(const CompensationTrial& trial) override;
  void on_warning(const std::string& warning) override;
  void on_restart(const Restart& restart) override;
  void on_end(const Odometry& odometry) override;

 private:
  Progress progress_;
  PointTimes times_;
  bool times_judged_ = false;  // whether the points have times: at the first sweep that has points
  std::size_t done_ = 0;
};

/// `poses_lidar.partial.txt` in the output folder (partial_poses.hpp), one pose per sweep, handed to the system
/// immediately: even a run that is killed leaves a valid beginning. It goes away when the whole files are in place.
class PartialPoses final : public SessionObserver {
 public:
  /// An empty `folder`: nothing is written.
  explicit PartialPoses(const std::filesystem::path& folder);

  /// @throws RunError, kCannotWrite, when the disk is full; the lines before stay.
  void on_registered(const RegisteredSweep& sweep) override;

  /// Forgets the poses so far. @throws RunError, kCannotWrite
  void on_restart(const Restart& restart) override;

  void remove();

 private:
  void open();

  std::filesystem::path file_;
  std::ofstream stream_;
  std::uintmax_t bytes_ = 0;    // of complete lines
  std::size_t next_sweep_ = 0;  // the one after the last
};

/// Few enough points of the map for the report's picture.
class MapPicture final : public SessionObserver {
 public:
  MapPicture();
  void on_registered(const RegisteredSweep& sweep) override;
  void on_restart(const Restart& restart) override;
  void on_end(const Odometry& odometry) override;
  /// Odometry frame, m; of the local map when no sweep belongs in the map.
  std::vector<Eigen::Vector3f> points() const;

 private:
  BudgetedMap map_;
  std::vector<Eigen::Vector3f> local_;
};

/// Hands every sweep to the viewer.
class ViewFeed final : public SessionObserver {
 public:
  explicit ViewFeed(LiveView& view) : view_(view) {}
  void on_registered(const RegisteredSweep& sweep) override;
  void on_restart(const Restart& restart) override;

 private:
  LiveView& view_;
};

/// Lets the run go no faster than the sweeps were recorded.
class Pace final : public SessionObserver {
 public:
  void on_read(const Sweep& sweep, const std::string& name) override;
  void on_restart(const Restart& restart) override;

 private:
  std::optional<std::int64_t> stamp_ns_;  // of the sweep before
  std::int64_t due_ns_ = 0;               // steady clock
};

}  // namespace rilo
