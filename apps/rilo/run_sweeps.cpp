#include "run_sweeps.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <thread>

#include <fmt/format.h>

#include "failure.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::cli {

namespace {

constexpr double kMapVoxelM = 0.2;
constexpr double kPictureVoxelM = 0.75;  // enough for the report's picture of the map

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

std::optional<std::size_t> sweeps_to_do(const RunFlags& flags, const ScanSource& source) {
  std::optional<std::size_t> total = source.size();
  if (total) *total -= std::min(*total, flags.start);
  if (flags.count > 0) total = std::min(total.value_or(flags.count), flags.count);
  return total;
}

// The very first sweep is put into the map before the velocity is known: its points are smeared when they have times.
bool belongs_in_map(const SweepResult& result, const Sweep& sweep) {
  switch (result.status) {
    case OdometryStatus::kLost:
    case OdometryStatus::kEmpty:
      return false;
    case OdometryStatus::kInitialising:
      return sweep.times_s.empty();
    default:
      return true;
  }
}

class SweepLoop {
 public:
  SweepLoop(const RunFlags& flags, ScanSource& source, PartialPoses& partial, RunRecord& run)
      : flags_(flags),
        source_(source),
        partial_(partial),
        run_(run),
        odometry_(run.config, steady_ns),
        map_wanted_(!flags.map.empty() || (!flags.out.empty() && !flags.no_report)),
        map_(flags.map.empty() ? kPictureVoxelM : kMapVoxelM),
        progress_("rilo", sweeps_to_do(flags, source), flags.quiet) {}

  void run() {
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    run_.threads = run_.config.threads > 0 ? run_.config.threads : static_cast<int>(processors);
    const std::int64_t begin = steady_ns();
    try {
      source_.skip(flags_.start);
      while (InterruptGuard::signal() == 0 && (flags_.count == 0 || run_.results.size() < flags_.count) && step()) {
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
    run_.source = source_.info();
    if (run_.results.empty() && run_.signal == 0 && run_.error.empty()) {
      fail(kBadData, fmt::format("{}: no sweep to run ({} could not be read, --start is {})", run_.data.string(),
                                 run_.source.bad_sweeps, flags_.start));
    }
    if (map_wanted_) run_.map = map_.points().empty() ? odometry_.local_map() : map_.points();
  }

 private:
  // False at the end of the data.
  bool step() {
    const std::optional<Sweep> sweep = source_.next();
    show_warnings();
    if (!sweep) return false;
    check_point_times(flags_.source, *sweep, source_.current_name());
    const SweepResult result = odometry_.register_sweep(*sweep);
    run_.results.push_back(result);
    run_.indices.push_back(source_.current_index());
    partial_.add(result.T_odom_lidar);
    if (map_wanted_ && belongs_in_map(result, *sweep)) map_.add(odometry_.last_map_points(), result.T_odom_lidar);
    const bool usual = result.status == OdometryStatus::kOk;
    progress_.update(run_.results.size(), usual ? "" : std::string(to_string(result.status)));
    return true;
  }

  // As they come: a run may take hours.
  void show_warnings() {
    const std::vector<std::string> warnings = source_.info().warnings;
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
  ScanSource& source_;
  PartialPoses& partial_;
  RunRecord& run_;
  Odometry odometry_;
  bool map_wanted_;  // for the file or the report
  ThinnedMap map_;
  Progress progress_;
  std::vector<std::string> shown_;
};

}  // namespace

void run_sweeps(const RunFlags& flags, ScanSource& source, PartialPoses& partial, RunRecord& run) {
  SweepLoop(flags, source, partial, run).run();
}

}  // namespace rilo::cli
