#include "results/run_observers.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "cloud/all_round.hpp"
#include "console/interrupt.hpp"
#include "console/text.hpp"
#include "io/stamp_difference.hpp"
#include "io/steady_clock.hpp"
#include "results/partial_poses.hpp"
#include "results/run_metrics.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

constexpr std::int64_t kLongestPauseNs = 10'000'000'000;  // of a pace: a gap in the recording is not waited for
constexpr std::int64_t kNapNs = 50'000'000;               // so that a signal ends it
constexpr double kPictureVoxelM = 0.75;
// 6 MB; beyond it the voxels grow: a long drive has small pixels anyway.
constexpr std::size_t kPicturePoints = 100'000;

/// What a user may know of points without times.
std::string times_to_give(const std::vector<Eigen::Vector3f>& points) {
  const bool in_order = order_times(points, 1).has_value();
  if (!in_order && !all_round(points)) return "";  // not of a sensor that turns
  return fmt::format(
      "; raw points of a spinning sensor: --point-times {}; points that are compensated: --point-times none",
      in_order ? "order" : "azimuth");
}

}  // namespace

void SweepCheck::on_read(const Sweep& sweep, const std::string& name) {
  check_point_times(flags_.source, sweep, name);
  if (flags_.map_intensity && sweep.intensities.size() != sweep.points.size()) {
    throw RunError(RunErrorKind::kBadData, name + ": no intensities; run without --map-intensity");
  }
}

ProgressLine::ProgressLine(const RunRequest& flags, const ScanSource& source)
    : progress_("rilo", sweeps_to_do(source, flags.start, flags.count), flags.quiet),
      times_(flags.source.options.point_times) {}

void ProgressLine::on_read(const Sweep& /*sweep*/, const std::string& /*name*/) {
  if (done_ == 0) progress_.start();  // after the trial of points without times, and again in a second pass
}

void ProgressLine::on_registered(const RegisteredSweep& sweep) {
  const bool first_points = !times_judged_ && times_ == PointTimes::kAuto && !sweep.sweep.points.empty();
  if (first_points) times_judged_ = true;
  if (first_points && sweep.sweep.times_s.empty()) {
    progress_.say("rilo: note: no per-point times: no motion compensation" + times_to_give(sweep.sweep.points));
  }
  const bool usual = sweep.result.status == OdometryStatus::kOk;
  progress_.update(++done_, usual ? "" : std::string(to_string(sweep.result.status)));
}

void ProgressLine::on_trial(const CompensationTrial& trial) {
  if (!trial.raw() && !trial.compensated()) return;
  times_judged_ = true;
  progress_.say(fmt::format("rilo: note: no per-point times; {} (--point-times {}: the other way)",
                            trial_outcome(trial), to_string(trial.raw() ? PointTimes::kNone : trial.times)));
}

void ProgressLine::on_warning(const std::string& warning) { progress_.say("rilo: warning: " + warning); }

void ProgressLine::on_restart(const Restart& restart) {
  progress_.say(
      fmt::format("rilo: learnt from {}: elevation offset of the sensor {:+.3f} deg, single beams rms {:.3f} deg{}; "
                  "restarting with them (not with --one-pass)",
                  counted(restart.after_sweeps, "sweep"), restart.elevation_offset_deg, restart.beam_elevation_rms_deg,
                  restart.begins_moving ? ", the motion at the beginning" : ""));
  done_ = 0;
}

void ProgressLine::on_end(const Odometry& /*odometry*/) { progress_.finish(); }

PartialPoses::PartialPoses(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  file_ = folder / kPartialPoses;
  open();
}

void PartialPoses::open() {
  stream_.open(file_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw RunError(RunErrorKind::kCannotWrite, file_.string() + ": cannot be opened for writing");
}

void PartialPoses::on_registered(const RegisteredSweep& sweep) {
  if (file_.empty()) return;
  const std::string line = partial_pose_line(sweep.result.T_odom_lidar, sweep.index, next_sweep_);
  next_sweep_ = sweep.index + 1;
  stream_ << line << std::flush;
  if (stream_) {
    bytes_ += line.size();
    return;
  }
  stream_.close();
  std::error_code ignored;
  std::filesystem::resize_file(file_, bytes_, ignored);  // half a line would spoil the file
  throw RunError(RunErrorKind::kCannotWrite, file_.string() + ": cannot be written; is the disk full?");
}

void PartialPoses::on_restart(const Restart& /*restart*/) {
  if (file_.empty()) return;
  stream_.close();
  bytes_ = 0;
  next_sweep_ = 0;
  open();
}

void PartialPoses::remove() {
  if (file_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

MapPicture::MapPicture() : map_(kPictureVoxelM, kPicturePoints) {}

void MapPicture::on_registered(const RegisteredSweep& sweep) {
  if (!belongs_in_map(sweep.result.status, !sweep.sweep.times_s.empty())) return;
  std::vector<Eigen::Vector3f> points = sweep.odometry.last_map_points();
  const Eigen::Isometry3f T = sweep.result.T_odom_lidar.cast<float>();
  for (Eigen::Vector3f& p : points) p = T * p;
  map_.add(points, 0);
}

void MapPicture::on_restart(const Restart& /*restart*/) { map_ = BudgetedMap(kPictureVoxelM, kPicturePoints); }

void MapPicture::on_end(const Odometry& odometry) {
  if (map_.points().empty()) local_ = odometry.local_map();
}

std::vector<Eigen::Vector3f> MapPicture::points() const {
  std::vector<Eigen::Vector3f> points = local_;
  for (const MapPoint& point : map_.points()) points.push_back(point.p);
  return points;
}

void ViewFeed::on_registered(const RegisteredSweep& sweep) { view_.show(sweep.index, sweep.result, sweep.sweep); }

void ViewFeed::on_restart(const Restart& /*restart*/) { view_.start_over(); }

void Pace::on_read(const Sweep& sweep, const std::string& /*name*/) {
  const std::int64_t now_ns = steady_ns();
  // Clocks that are set back or jump do not stop the run; one that cannot keep up does not hurry afterwards.
  const std::int64_t step_ns = detail::stamp_difference(sweep.stamp_ns, stamp_ns_.value_or(sweep.stamp_ns));
  due_ns_ = std::max(now_ns, due_ns_ + std::clamp<std::int64_t>(step_ns, 0, kLongestPauseNs));
  stamp_ns_ = sweep.stamp_ns;
  while (steady_ns() < due_ns_ && InterruptGuard::signal() == 0) {
    std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(due_ns_ - steady_ns(), kNapNs)));
  }
}

void Pace::on_restart(const Restart& /*restart*/) { stamp_ns_.reset(); }

}  // namespace rilo
