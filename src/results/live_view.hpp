// The viewer of a run, live or recorded, with the truth beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "results/run_record.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "view/viewer.hpp"

namespace rilo {

/// True positions of the sweeps in the odometry frame: the first true pose laid onto the first estimate, nothing else.
class TruthTrack {
 public:
  /// Of what lies beside the data; none when there is nothing, or it cannot be read.
  explicit TruthTrack(const std::filesystem::path& data);

  /// The next estimate is the first one.
  void start_over() { T_odom_world_.reset(); }

  /// Of the sweep at that place in the data, whose pose was estimated as `estimate`.
  std::optional<Eigen::Vector3d> at(std::size_t index, const SE3& estimate);

 private:
  std::vector<SE3> T_world_lidar_;
  std::optional<SE3> T_odom_world_;
};

class LiveView {
 public:
  /// @throws RunError, kUsage, when there is no viewer in this build, or it cannot be bound.
  LiveView(const ViewInfo& info, const ViewOptions& options, std::optional<TruthTrack> truth);
  /// Reports why the viewer ended early, if it did.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Hands over a sweep. A live one may lose its points, see Viewer::push.
  void show(std::size_t index, const SweepResult& result, Sweep sweep);
  /// After the run: reads the sweeps again whose points were dropped, from `source`, which is at its beginning. A
  /// signal ends it. @throws IoError
  void show_missing(ScanSource& source, const RunRecord& run);
  /// Forgets what was shown.
  void start_over();
  Viewer& viewer() { return *viewer_; }

 private:
  bool live_;
  std::optional<TruthTrack> truth_;
  std::unique_ptr<Viewer> viewer_;
};

/// What both kinds have in common.
ViewInfo view_info(const std::string& data, const OdometryConfig& config);

/// For each point of a map the first of `results` that was near it, or the nearest one: the order in which a finished
/// run saw its map. Points within a few metres of each other have the same.
std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results);

}  // namespace rilo
