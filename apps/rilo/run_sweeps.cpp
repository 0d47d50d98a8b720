#include "run_sweeps.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "failure.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/geometry/degrees.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::cli {

namespace {

constexpr double kPictureVoxelM = 0.75;        // enough for the report's picture of the map
constexpr std::size_t kStartOverWithin = 200;  // sweeps: later, the beginning is a small part of the run

std::int64_t steady_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

// Of this program alone: getrusage may give the peak of the process that started it.
double peak_rss_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kib = 0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

class SweepLoop {
 public:
  SweepLoop(const RunFlags& flags, std::unique_ptr<ScanSource> source, PartialPoses& partial, RunRecord& run,
            LiveView* view)
      : flags_(flags),
        source_(std::move(source)),
        partial_(partial),
        run_(run),
        view_(view),
        odometry_(new_odometry()),
        map_wanted_(!flags.map.empty() || (!flags.out.empty() && !flags.no_report)),
        map_voxel_m_(flags.map.empty() ? kPictureVoxelM : flags.map_voxel_m),
        map_(map_voxel_m_),
        progress_("rilo", sweeps_to_do(flags, *source_), flags.quiet) {}

  void run() {
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    run_.threads = run_.config.threads > 0 ? run_.config.threads : static_cast<int>(processors);
    const std::int64_t begin = steady_ns();
    try {
      source_->skip(flags_.start);
      while (InterruptGuard::signal() == 0 && (flags_.count == 0 || run_.results.size() < flags_.count) && step()) {
        if (start_over_due()) start_over();
      }
    } catch (const CommandError& error) {
      fail(error.code(), error.what());
    } catch (const IoError& error) {
      fail(kBadData, error.what());
    } catch (const std::exception&) {
      fail(kUnexpected, current_failure().message);
    }
    progress_.finish();
    run_.signal = InterruptGuard::signal();
    run_.wall_s = static_cast<double>(steady_ns() - begin) * 1e-9;
    run_.peak_rss_mb = peak_rss_mb();
    run_.source = source_->info();
    if (run_.results.empty() && run_.signal == 0 && run_.error.empty()) {
      fail(kBadData, fmt::format("{}: no sweep to run ({} could not be read, --start is {})", run_.data.string(),
                                 run_.source.bad_sweeps, flags_.start));
    }
    if (map_wanted_) run_.map = map_.cloud(flags_.map_normals);
    if (run_.map.points.empty() && map_wanted_) run_.map.points = odometry_.local_map();
  }

 private:
  Odometry new_odometry() const {
    Odometry odometry(run_.config, steady_ns);
    odometry.keep_intensities(flags_.map_intensity);
    return odometry;
  }

  // False at the end of the data.
  bool step() {
    std::optional<Sweep> sweep = source_->next();
    show_warnings();
    if (!sweep) return false;
    check_point_times(flags_.source, *sweep, source_->current_name());
    check_intensities(*sweep);
    const SweepResult result = odometry_.register_sweep(*sweep);
    run_.results.push_back(result);
    run_.indices.push_back(source_->current_index());
    partial_.add(result.T_odom_lidar);
    if (map_wanted_ && belongs_in_map(result.status, !sweep->times_s.empty())) {
      map_.add(odometry_.last_map_points(), result.T_odom_lidar, odometry_.last_map_intensities());
    }
    const bool usual = result.status == OdometryStatus::kOk;
    progress_.update(run_.results.size(), usual ? "" : std::string(to_string(result.status)));
    if (view_ != nullptr) view_->show(source_->current_index(), result, std::move(*sweep));
    return true;
  }

  void check_intensities(const Sweep& sweep) const {
    if (flags_.map_intensity && sweep.intensities.size() != sweep.points.size()) {
      throw CommandError(kBadData, source_->current_name() + ": no intensities; leave out --map-intensity");
    }
  }

  // The elevation error has just become certain, and the sweeps before were registered without its correction.
  bool start_over_due() const {
    const bool corrected = run_.results.back().stats.elevation_applied_rad != 0.0;
    return !flags_.one_pass && !run_.started_over_after && corrected && run_.config.elevation.initial_deg == 0.0 &&
           run_.results.size() <= kStartOverWithin;
  }

  void start_over() {
    // Before anything is given up: the data may be gone meanwhile.
    auto source = open_scan_source(flags_.data, flags_.source.options);
    source->skip(flags_.start);
    run_.started_over_after = run_.results.size();
    run_.config.elevation.initial_deg = kDegPerRad * run_.results.back().stats.elevation_offset_rad;
    progress_.say(
        fmt::format("rilo: the sensor's elevation error is certain after {} sweeps: starting over with {:+.3f} deg",
                    run_.results.size(), run_.config.elevation.initial_deg));
    run_.results.clear();
    run_.indices.clear();
    source_ = std::move(source);
    partial_.start_over();
    if (view_ != nullptr) view_->start_over();
    odometry_ = new_odometry();
    map_ = ThinnedMap(map_voxel_m_);
  }

  // As they come: a run may take hours.
  void show_warnings() {
    const std::vector<std::string> warnings = source_->info().warnings;
    for (const std::string& warning : warnings) {
      if (std::find(shown_.begin(), shown_.end(), warning) == shown_.end()) {
        progress_.say("rilo: warning: " + warning);
        shown_.push_back(warning);
      }
    }
  }

  void fail(ExitCode code, const std::string& message) {
    run_.error_code = code;
    run_.error = message;
  }

  const RunFlags& flags_;
  std::unique_ptr<ScanSource> source_;
  PartialPoses& partial_;
  RunRecord& run_;
  LiveView* view_;
  Odometry odometry_;
  bool map_wanted_;  // for the file or the report
  double map_voxel_m_;
  ThinnedMap map_;
  Progress progress_;
  std::vector<std::string> shown_;
};

}  // namespace

std::optional<std::size_t> sweeps_to_do(const RunFlags& flags, const ScanSource& source) {
  std::optional<std::size_t> total = source.size();
  if (total) *total -= std::min(*total, flags.start);
  if (flags.count > 0) total = std::min(total.value_or(flags.count), flags.count);
  return total;
}

void run_sweeps(const RunFlags& flags, std::unique_ptr<ScanSource> source, PartialPoses& partial, RunRecord& run,
                LiveView* view) {
  SweepLoop(flags, std::move(source), partial, run, view).run();
}

}  // namespace rilo::cli
