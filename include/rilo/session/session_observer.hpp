// Observation of a run while it is running; the observer that collects the map.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "rilo/cloud/sweep.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/io/source_options.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// A sweep that has just been registered. The references are valid during the call.
struct RegisteredSweep {
  std::size_t index;          ///< place in the data (ScanSource::current_index)
  const Sweep& sweep;         ///< as read
  const SweepResult& result;  ///< its pose and statistics
  const Odometry& odometry;   ///< right after it; last_map_points(): of the last sweep that went into a map
};

/// The second pass begins: everything before is forgotten.
struct Restart {
  std::size_t after_sweeps = 0;       ///< registered in the first pass
  double elevation_offset_deg = 0;    ///< applied from the first sweep of the second pass on
  double beam_elevation_rms_deg = 0;  ///< of the corrections of single beams, likewise
  bool begins_moving = false;         ///< with the velocity of the first pass, whose map began late
};

/// The same sweeps, registered without times and with them. With them raw points are nearer to the planes of the map,
/// compensated ones are not; and raw points lie on the cones of the sensor's beams, compensated ones do not.
struct CompensationTrial {
  /// Which times: their own (kAuto), or those of order_times() or of azimuth_times(), clockwise; kNone: not tried.
  PointTimes times = PointTimes::kNone;
  std::size_t sweeps = 0;     ///< compared: those during which the sensor moved by more than the noise of good poses
  std::size_t better = 0;     ///< of these, with the times
  std::size_t on_cones = 0;   ///< of these, raw by the cones
  std::size_t off_cones = 0;  ///< of these, compensated by the cones
  std::size_t lost = 0;  ///< with the times, or where a map had to begin again: what fits a wrong path says nothing
  double turn_s = 0;     ///< how long the sensor turns for a sweep, of the times that were tried

  /// At least ten sweeps were compared, and hardly any was lost.
  bool certain() const;
  /// Certain, 0.6 of the sweeps are better, and by the cones they are not compensated; with azimuth_times() raw.
  bool raw() const;
  /// By the cones; or certain and at most 0.4 of the sweeps are better, but with azimuth_times().
  bool compensated() const;

 private:
  bool by_cones(std::size_t so_many) const;
};

/// Called by Session::run(), on its thread, in the order of the events. An exception ends the run and
/// is kept in SessionResult::failure.
class SessionObserver {
 public:
  virtual ~SessionObserver() = default;

  /// A sweep was read and is registered next. `name`: for messages (ScanSource::current_name).
  virtual void on_read(const Sweep& /*sweep*/, const std::string& /*name*/) {}
  virtual void on_registered(const RegisteredSweep& /*sweep*/) {}
  /// Before the first sweep: points without times were tried, and are taken as raw when trial.raw().
  virtual void on_trial(const CompensationTrial& /*trial*/) {}
  /// A sentence for the user, each once.
  virtual void on_warning(const std::string& /*warning*/) {}
  virtual void on_restart(const Restart& /*restart*/) {}
  /// The run ended, whatever ended it.
  virtual void on_end(const Odometry& /*odometry*/) {}

 protected:
  SessionObserver() = default;
  SessionObserver(const SessionObserver&) = default;
  SessionObserver& operator=(const SessionObserver&) = default;
};

/// Collects the points of all sweeps with a pose that can be trusted (belongs_in_map), the first one of every voxel.
class MapObserver final : public SessionObserver {
 public:
  /// `voxel_m`: edge of the voxels, m. @throws std::invalid_argument as ThinnedMap.
  explicit MapObserver(double voxel_m) : voxel_m_(voxel_m), map_(voxel_m) {}

  void on_registered(const RegisteredSweep& sweep) override;
  void on_restart(const Restart& restart) override;
  void on_end(const Odometry& odometry) override;

  /// After the run, odometry frame (m). When no sweep belongs in it: the local map, without normals and intensities.
  /// Intensities are there when SessionOptions::keep_intensities.
  MapCloud cloud(bool with_normals) const;

 private:
  double voxel_m_;
  ThinnedMap map_;
  std::vector<Eigen::Vector3f> local_;
};

}  // namespace rilo
