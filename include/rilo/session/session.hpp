// One run: sweeps of a source through the odometry, to observers and a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rilo/geometry/trajectory.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"
#include "rilo/session/session_observer.hpp"

namespace rilo {

/// Cause of a RunError.
enum class RunErrorKind : std::uint8_t {
  kUsage,        ///< the request makes no sense: options, configuration
  kBadData,      ///< data missing, malformed or not fit for the request
  kCannotWrite,  ///< a result could not be written
  kUnexpected,   ///< a bug or an exhausted machine
};

/// A run, or the writing of its results, has failed.
class RunError : public std::runtime_error {
 public:
  RunError(RunErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  RunErrorKind kind() const { return kind_; }

 private:
  RunErrorKind kind_;
};

/// The first pass, in which the sensor is learnt, ends after that many sweeps: 20 s at 10 Hz.
inline constexpr std::size_t kCalibrationSweeps = 200;

struct SessionOptions {
  OdometryConfig config;
  std::optional<SensorAngles> calibration;  ///< Odometry::start_with
  std::size_t start = 0;                    ///< sweeps skipped at the beginning of the data
  std::size_t count = 0;                    ///< sweeps to run at most; 0: all
  /// Single pass, as in live operation. Otherwise the run starts over, once, with what the first kCalibrationSweeps (or
  /// all, if there are fewer) say about the sensor, its elevation offset and the angles of its beams, so that the first
  /// sweeps have the corrections, too.
  bool one_pass = false;
  /// As the source was opened. With kAuto, points that come without times are tried: when they fit better with those of
  /// their order, the run takes them (not in a single pass, which does not look ahead).
  PointTimes point_times = PointTimes::kNone;
  /// Of data without stamps nobody has said how many sweeps a second they are. Where many of the first ones go astray
  /// at the rate assumed, and half as many at a fifth of it, the run takes that (not in a single pass).
  bool rate_assumed = false;
  bool keep_intensities = false;      ///< Odometry::keep_intensities
  std::function<bool()> interrupted;  ///< called before every sweep; true ends the run there. Empty: never
};

/// Result of a run, complete whatever ended it.
struct SessionResult {
  std::vector<SweepResult> results;              ///< one per registered sweep, in order
  std::vector<std::size_t> indices;              ///< place of each sweep in the data
  SourceInfo source;                             ///< at the end of the run
  OdometryConfig config;                         ///< as given
  int threads = 0;                               ///< used by the odometry
  CompensationTrial trial;                       ///< of points without times
  std::optional<Restart> restart;                ///< when there was a second pass
  double elevation_given_deg = 0;                ///< offset of the calibration; without one elevation.initial_deg
  SensorAngles learnt;                           ///< after the pass with more sweeps, with where it was learnt
  std::size_t learnt_from = 0;                   ///< sweeps of that pass
  PoseInstant pose_instant = PoseInstant::kMid;  ///< of the sweep, that the poses refer to
  double wall_s = 0;                             ///< duration of both passes; not of what is tried before
  double peak_rss_mb = 0;                        ///< largest memory of this process so far
  bool interrupted = false;                      ///< by SessionOptions::interrupted
  std::exception_ptr failure;                    ///< that ended the run; null: none

  Trajectory trajectory() const;
};

/// Opens the data from the beginning; called again for the second pass.
using OpenSource = std::function<std::unique_ptr<ScanSource>()>;

/// How many of `source`'s sweeps `start` and `count` leave, when that is known.
std::optional<std::size_t> sweeps_to_do(const ScanSource& source, std::size_t start, std::size_t count);

/// One run, observed. Use once; not thread-safe.
class Session {
 public:
  /// Opens the source. @throws what `open` throws; std::invalid_argument when a value of the configuration is out of
  /// range, or the calibration was learnt with another elevation correction than that of the source.
  Session(OpenSource open, SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Observers are called in the order in which they were added; they must outlive run().
  void add(SessionObserver& observer);

  const ScanSource& source() const;

  /// Runs to the end of the data, `count`, the interrupt or an error, which is kept in the result: what was done before
  /// it is kept. No sweep to run is an error (RunError, kBadData).
  SessionResult run();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Runs a recording: opens `data` (see open_scan_source) and runs it in two passes unless options.one_pass. The poses
/// are those of `rilo run` with the same options, to the last bit.
/// @throws what ended the run: IoError, RunError, std::invalid_argument.
SessionResult run_recording(const std::filesystem::path& data, const SessionOptions& options = {},
                            const SourceOptions& source = {});

}  // namespace rilo
