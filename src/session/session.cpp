#include "rilo/session/session.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "calibration/same_sensor.hpp"
#include "geometry/degrees.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/steady_clock.hpp"
#include "io/text.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/point_times.hpp"
#include "session/assumed_rate.hpp"
#include "session/beam_cones.hpp"
#include "session/compensation_trial.hpp"
#include "session/dropped_calibration.hpp"
#include "session/map_beginnings.hpp"
#include "session/process_memory.hpp"
#include "session/processors.hpp"

namespace rilo {

namespace {

std::string absolute_path(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(path, ignored).string();
}

}  // namespace

class Session::Impl {
 public:
  Impl(OpenSource open, SessionOptions options)
      : open_(std::move(open)),
        options_(std::move(options)),
        source_(open_()),
        recording_(absolute_path(source_->info().path)),
        odometry_(new_odometry()) {}

  void add(SessionObserver& observer) { observers_.push_back(&observer); }
  const ScanSource& source() const { return *source_; }

  SessionResult run() {
    result_.threads = options_.config.threads > 0 ? options_.config.threads : usable_processors();
    if (!options_.one_pass) guarded([this] { look_ahead(); });
    const std::int64_t begin_ns = steady_ns();
    if (!result_.failure) guarded([this] { run_sweeps(); });
    result_.wall_s = static_cast<double>(steady_ns() - begin_ns) * 1e-9;
    result_.peak_rss_mb = detail::peak_memory_mb();
    result_.source = info();
    result_.config = options_.config;
    result_.elevation_given_deg = elevation_given_deg();
    // A second pass that was ended early has learnt less than the first.
    if (result_.results.size() >= result_.learnt_from) keep_learnt();
    guarded([this] { give_last_warnings(); });
    guarded([this] {
      for (SessionObserver* observer : observers_) observer->on_end(odometry_);
    });
    return std::move(result_);
  }

 private:
  // The first error is what ended the run.
  template <typename Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (...) {
      if (!result_.failure) result_.failure = std::current_exception();
    }
  }

  Odometry new_odometry() const {
    Odometry odometry(options_.config, steady_ns);
    odometry.keep_intensities(options_.keep_intensities);
    if (options_.calibration) {
      check_reading(*options_.calibration, source_->info().elevation_correction_deg);
      odometry.start_with(*options_.calibration);
    }
    return odometry;
  }

  bool is_among(const std::vector<std::string>& recordings) const {
    return std::find(recordings.begin(), recordings.end(), recording_) != recordings.end();
  }

  SourceInfo info() const {
    SourceInfo info = source_->info();
    if (options_.calibration && is_among(options_.calibration->recordings)) {
      info.warnings.push_back(name_of(*options_.calibration) +
                              ": learnt from this recording too: errors look smaller than on a new one");
    }
    if (rate_trial_.slower()) info.warnings.push_back(rate_trial_.sentence());
    if (cones_.compensated()) {
      info.warnings.emplace_back(
          "the points have times, but seem to be compensated for the motion already (they lie on the cones of the "
          "beams once that is undone): try --point-times none");
    }
    return info;
  }

  bool interrupted() {
    result_.interrupted = options_.interrupted && options_.interrupted();
    return result_.interrupted;
  }

  void run_sweeps() {
    const std::size_t count = options_.count > 0 ? options_.count : std::numeric_limits<std::size_t>::max();
    source_->skip(options_.start);
    if (!options_.one_pass) {
      run_until(std::min(count, kCalibrationSweeps));
      if (!result_.interrupted) start_over_with_what_is_known();
    }
    run_until(count);
    if (result_.results.empty() && !result_.interrupted) throw RunError(RunErrorKind::kBadData, nothing_to_run());
  }

  void run_until(std::size_t sweeps) {
    while (result_.results.size() < sweeps && !interrupted() && step()) {
    }
  }

  // With the times and the rate that were found; a sweep does not last longer because fewer of them were kept.
  std::unique_ptr<ScanSource> opened() const {
    return rate_trial_.slower() ? detail::with_slower_stamps(open_(), RateTrial::kTimesSlower) : open_();
  }

  // What nobody has said of the data, and the first sweeps show.
  void look_ahead() {
    try_times();
    try_rate();
    // Sweeps that go astray at a wrong rate do not show whether their points are raw.
    if (rate_trial_.slower() && !result_.trial.raw() && !result_.trial.compensated()) try_times();
    if (result_.trial.times == PointTimes::kAuto || result_.trial.times == PointTimes::kNone) return;
    for (SessionObserver* observer : observers_) observer->on_trial(result_.trial);
  }

  // Raw points without times are common, and nothing but the fit tells them from compensated ones.
  void try_times() {
    if (options_.point_times != PointTimes::kAuto || source_->info().has_point_times) return;
    result_.trial = try_compensation(open_, options_.start, options_.config, options_.interrupted,
                                     rate_trial_.slower() ? RateTrial::kTimesSlower : 1);
    if (result_.trial.times == PointTimes::kAuto || !result_.trial.raw()) return;
    const bool in_order = result_.trial.times == PointTimes::kOrder;
    const auto timed = in_order ? detail::with_order_times : detail::with_azimuth_times;
    open_ = [open = std::move(open_), timed, turn_s = result_.trial.turn_s] { return timed(open(), turn_s); };
    source_ = opened();
  }

  // A robot that is seen twice a second does not go on as one that is seen ten times.
  void try_rate() {
    if (!options_.rate_assumed || !source_->info().stamps_assumed) return;
    // However many of them are to be run: the first poses of a run do not depend on where it ends.
    rate_trial_ = try_slower_rate(open_, options_.start, kCalibrationSweeps, options_.config, options_.interrupted);
    if (rate_trial_.slower()) source_ = opened();
  }

  // False at the end of the data.
  bool step() {
    const std::optional<Sweep> sweep = source_->next();
    give_warnings();
    if (!sweep) return false;
    for (SessionObserver* observer : observers_) observer->on_read(*sweep, source_->current_name());
    SweepResult result = odometry_.register_sweep(*sweep);
    result.stamp_ns = pose_stamp_ns(result.stamp_ns, sweep->stamp_ns);
    result_.results.push_back(result);
    result_.indices.push_back(source_->current_index());
    if (options_.config.preprocess.deskew && cones_.open()) {
      cones_.add(*sweep, result_.results.back(), detail::turn_s(source_->info().period_s));
    }
    const RegisteredSweep registered{result_.indices.back(), *sweep, result_.results.back(), odometry_};
    for (SessionObserver* observer : observers_) observer->on_registered(registered);
    return true;
  }

  // Whether something was learnt about the sensor, which the sweeps before were registered without.
  bool knows_sensor() const {
    if (result_.results.empty()) return false;
    const SweepStats& last = result_.results.back().stats;
    return last.elevation_applied_rad != kRadPerDeg * elevation_given_deg() || last.beam_elevation_rms_rad > 0.0 ||
           last.beam_azimuth_rms_rad > 0.0;
  }

  double elevation_given_deg() const {
    return options_.calibration ? kDegPerRad * options_.calibration->elevation_offset_rad
                                : options_.config.elevation.initial_deg;
  }

  void keep_learnt() {
    SensorAngles& learnt = result_.learnt;
    learnt = odometry_.sensor_angles();
    learnt.elevation_correction_deg = source_->info().elevation_correction_deg;
    if (!recording_.empty() && !is_among(learnt.recordings)) learnt.recordings.push_back(recording_);
    result_.learnt_from = result_.results.size();
  }

  void start_over_with_what_is_known() {
    const std::optional<KnownVelocity> velocity = velocity_after_late_beginning(result_.results);
    if (!velocity && !knows_sensor()) return;
    // Before anything is given up: the data may be gone meanwhile.
    auto source = opened();
    source->skip(options_.start);
    source_ = std::move(source);
    keep_learnt();
    const double beams_rad = result_.results.back().stats.beam_elevation_rms_rad;
    result_.restart = {result_.results.size(), kDegPerRad * odometry_.start_over(velocity), kDegPerRad * beams_rad,
                       velocity.has_value()};
    result_.results.clear();
    result_.indices.clear();
    for (SessionObserver* observer : observers_) observer->on_restart(*result_.restart);
  }

  // As they come: a run may take hours.
  void give_warnings() {
    const std::vector<std::string> warnings = info().warnings;
    for (const std::string& warning : warnings) {
      if (std::find(given_.begin(), given_.end(), warning) != given_.end()) continue;
      given_.push_back(warning);
      for (SessionObserver* observer : observers_) observer->on_warning(warning);
    }
  }

  // About the whole run.
  void give_last_warnings() {
    const std::string dropped = options_.calibration ? dropped_calibration(*options_.calibration, result_.learnt,
                                                                           options_.config.elevation.significance)
                                                     : "";
    for (const std::string& warning : {further_maps(result_.results, result_.indices),
                                       doubtful_rate(result_.source, result_.results, rate_trial_), dropped}) {
      if (warning.empty()) continue;
      result_.source.warnings.push_back(warning);
      for (SessionObserver* observer : observers_) observer->on_warning(warning);
    }
  }

  std::string nothing_to_run() const {
    const SourceInfo info = source_->info();
    const std::string path = info.path.string();
    const std::optional<std::size_t> size = source_->size();
    if (size && options_.start >= *size) {
      return fmt::format("{}: no sweep to run: start {} is past the last of {}", path, options_.start,
                         detail::counted(*size, "sweep"));
    }
    return fmt::format("{}: no sweep to run ({} could not be read)", path, info.bad_sweeps);
  }

  OpenSource open_;
  SessionOptions options_;
  std::unique_ptr<ScanSource> source_;
  std::string recording_;  // its path, absolute; empty: unknown
  Odometry odometry_;
  std::vector<SessionObserver*> observers_;
  SessionResult result_;
  RateTrial rate_trial_;
  ConeVotes cones_;
  std::vector<std::string> given_;  // warnings
};

Trajectory SessionResult::trajectory() const {
  Trajectory trajectory;
  trajectory.reserve(results.size());
  for (const SweepResult& result : results) trajectory.push_back({result.stamp_ns, result.T_odom_lidar});
  return trajectory;
}

std::optional<std::size_t> sweeps_to_do(const ScanSource& source, std::size_t start, std::size_t count) {
  std::optional<std::size_t> total = source.size();
  if (total) *total -= std::min(*total, start);
  if (count > 0) total = std::min(total.value_or(count), count);
  return total;
}

Session::Session(OpenSource open, SessionOptions options)
    : impl_(std::make_unique<Impl>(std::move(open), std::move(options))) {}

Session::~Session() = default;

void Session::add(SessionObserver& observer) { impl_->add(observer); }

const ScanSource& Session::source() const { return impl_->source(); }

SessionResult Session::run() { return impl_->run(); }

SessionResult run_recording(const std::filesystem::path& data, const SessionOptions& options,
                            const SourceOptions& source) {
  SessionOptions as_opened = options;
  as_opened.point_times = source.point_times;
  as_opened.rate_assumed = !source.rate_hz;
  SessionResult result = Session([&] { return open_scan_source(data, source); }, as_opened).run();
  if (result.failure) std::rethrow_exception(result.failure);
  return result;
}

}  // namespace rilo
