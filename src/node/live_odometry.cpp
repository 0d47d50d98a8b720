#include "rilo/node/live_odometry.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "io/steady_clock.hpp"
#include "io/text.hpp"
#include "node/base_frame.hpp"
#include "node/node_health.hpp"
#include "node/odometry_session.hpp"
#include "node/throttle.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/map_writer.hpp"

namespace rilo {
namespace {

std::shared_ptr<LiveQueue> queue_for(const NodeOptions& options, const std::string& topic) {
  return std::make_shared<LiveQueue>(LiveQueueOptions{.topic = topic,
                                                      .limit = static_cast<std::size_t>(options.queue),
                                                      .look_ahead = static_cast<std::size_t>(options.look_ahead)});
}

}  // namespace

class LiveOdometry::Impl {
 public:
  Impl(const NodeOptions& node_options, const std::string& topic, NodeOutput& node_output)
      : queue(queue_for(node_options, topic)),
        output_(node_output),
        options_(node_options),
        session_(node_options, queue) {}

  ~Impl() { stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void start() {
    thread_ = std::thread([this] { work(); });
  }

  void stop() {
    stopping_ = true;
    queue->close();
    const std::lock_guard lock(ending_);
    if (thread_.joinable()) thread_.join();
  }

  void reset() {
    const std::lock_guard lock(mutex_);
    session_.open_anew();  // the driver may have been started again, with another frame or other times
    reset_held();
  }

  void set_pose(const SE3& T) {
    const std::lock_guard lock(mutex_);
    session_.set_pose(T);
  }

  bool set_parameters(const std::map<std::string, ParameterValue>& changes) {
    const std::lock_guard lock(mutex_);
    NodeOptions changed = with_parameters(options_, changes);
    const NodeParameters parameters(changed);
    bool waits = false;
    for (const auto& [name, value] : changes) {
      const ParameterChange change = parameters.at(name).change();
      if (change == ParameterChange::kNever) {
        throw std::invalid_argument("parameter " + name + ": expected no change while the node runs");
      }
      waits = waits || change == ParameterChange::kAtReset;
    }
    options_ = std::move(changed);
    config_changed_ = config_changed_ || waits;
    return waits;
  }

  std::string odom_frame() const {
    const std::lock_guard lock(mutex_);
    return options_.odom_frame;
  }

  PathMessage path() const {
    const std::lock_guard lock(mutex_);
    return path_message(session_.path(), options_.odom_frame);
  }

  CloudMessage local_map() const {
    const std::lock_guard lock(mutex_);
    return cloud_message(session_.local_map(), last_stamp_ns_, options_.odom_frame);
  }

  std::vector<Eigen::Vector3f> map() const {
    const std::lock_guard lock(mutex_);
    return session_.map();
  }

  const std::shared_ptr<LiveQueue> queue;
  NodeHealth health;

 private:
  void work() {
    try {
      while (!stopping_ && step()) {
      }
    } catch (const std::exception& error) {
      output_.fail(error.what());
    }
  }

  // False at the end.
  bool step() {
    try {
      if (!session_.next_sweep()) return false;
      if (session_.times_opened() != times_opened_) {
        times_opened_ = session_.times_opened();
        base_frame_.reset();
      }
      for (const std::string& warning : session_.new_warnings()) output_.warn(warning);
      tell_drops();
      const SourceFigures figures = session_.figures();
      health.note_source(figures);
      if (!base_frame_ && !find_extrinsic(frame_name(figures.lidar_frame))) return false;
      process(figures.clock_jumps);
    } catch (const IoError& error) {
      if (bad_message_.due()) output_.warn(std::string("dropped: ") + error.what());
      health.note_bad_message(error.what());
    }
    return true;
  }

  void tell_drops() {
    const std::size_t dropped = queue->counts().dropped;
    if (dropped == dropped_told_ || !drops_.due()) return;
    output_.warn(detail::counted(dropped, "sweep") +
                 " dropped since the start: they come faster than they are registered");
    dropped_told_ = dropped;
  }

  NodeOptions held_options() const {
    const std::lock_guard lock(mutex_);
    return options_;
  }

  // Waits until it is known. False when the node ends before.
  bool find_extrinsic(const std::string& lidar_frame) {
    const NodeOptions options = held_options();
    const std::string base = options.base_frame.empty() ? lidar_frame : options.base_frame;
    if (options.base_to_lidar.empty() && base != lidar_frame) {
      const std::string lidar = lidar_frame.empty() ? "the messages' frame, which they do not name" : lidar_frame;
      const std::string wanted = "the transform " + base + " to " + lidar;
      health.note_waiting(wanted + " in TF (or the parameter base_to_lidar)");
      Throttle complaint;
      std::optional<SE3> T;
      while (lidar_frame.empty() || !(T = output_.look_up(base, lidar_frame))) {
        if (stopping_) return false;
        if (complaint.due()) output_.warn("waiting for " + wanted + ": publish it, or set base_to_lidar");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      health.note_waiting("");
      const std::lock_guard lock(mutex_);
      session_.set_extrinsic(*T);
    }
    base_frame_ = base;
    if (!options.base_to_lidar.empty() && base == lidar_frame) {
      output_.warn(
          "base_frame is the messages' own frame, " + base +
          ": base_to_lidar moves all poses and maps within it; leave it out, or set base_frame to the robot's");
    }
    if (base.empty() || base == options.odom_frame) {
      output_.warn(base.empty() ? "the messages name no frame: nothing on /tf without base_frame and base_to_lidar"
                                : "the messages' frame is " + base + ", as odom_frame: nothing on /tf; set either");
    }
    return true;
  }

  void process(std::size_t clock_jumps) {
    const std::int64_t begin_ns = steady_ns();
    const std::lock_guard lock(mutex_);
    jumped_ = jumped_ || clock_jumps > jumps_seen_;
    jumps_seen_ = clock_jumps;
    SweepResult result = session_.register_sweep();
    if (jumped_ && result.status != OdometryStatus::kEmpty) {
      jumped_ = false;
      result = after_jump(result);
    }
    last_stamp_ns_ = result.stamp_ns;
    tell_losses(health.note_sweep(result));
    publish(result, session_.last_step_s());
    session_.add_to_map(result.status);
    health.note_end(static_cast<double>(steady_ns() - begin_ns) * 1e-6, session_.map_points(), session_.map_is_full());
  }

  // A wrong stamp, or a clock that was set, does not move the sensor. A bag that is played again does.
  SweepResult after_jump(const SweepResult& result) {
    constexpr const char* kBack = "the stamps went back in time";
    if (result.status != OdometryStatus::kLost) {
      output_.warn(std::string(kBack) + ", but the sweep fits: the odometry goes on");
      return result;
    }
    output_.warn(std::string(kBack) + ", and the sweep does not fit (a bag played again?): the odometry restarts");
    reset_held();
    return session_.register_sweep();
  }

  void tell_losses(const NodeHealth::News& news) {
    if (!news.lost.empty() && losses_.due()) output_.warn(news.lost);
    if (!news.new_map.empty() && new_maps_.due()) output_.warn(news.new_map);
  }

  // With the session held, as all that follows.
  void publish(const SweepResult& result, double step_s) {
    output_.publish(odometry_message(result, step_s, options_.odom_frame, *base_frame_));
    if (options_.publish_tf && !base_frame_->empty() && *base_frame_ != options_.odom_frame) {
      output_.publish(transform_message(result, options_.invert_tf, options_.odom_frame, *base_frame_));
    }
    if (due(path_stamp_ns_, options_.path_period_s, output_.path_wanted())) {
      output_.publish(path_message(session_.path(), options_.odom_frame));
    }
    if (due(map_stamp_ns_, options_.local_map_period_s, output_.local_map_wanted())) {
      output_.publish(cloud_message(session_.local_map(), last_stamp_ns_, options_.odom_frame));
    }
  }

  bool due(std::optional<std::int64_t>& published_ns, double period_s, bool wanted) const {
    const double since_s = published_ns ? static_cast<double>(last_stamp_ns_ - *published_ns) * 1e-9 : period_s;
    if (since_s < period_s || !wanted) return false;
    published_ns = last_stamp_ns_;
    return true;
  }

  void reset_held() {
    session_.reset(config_changed_ ? std::optional(options_.config) : std::nullopt);
    config_changed_ = false;
    path_stamp_ns_.reset();
    map_stamp_ns_.reset();
    health.note_reset();
  }

  NodeOutput& output_;

  mutable std::mutex mutex_;  // for the session (all but next_sweep()) and what follows
  NodeOptions options_;
  OdometrySession session_;
  bool config_changed_ = false;
  std::int64_t last_stamp_ns_ = 0;
  std::optional<std::int64_t> path_stamp_ns_;
  std::optional<std::int64_t> map_stamp_ns_;

  // Of the thread.
  std::optional<std::string> base_frame_;  // once the transform is known
  std::size_t times_opened_ = 0;
  std::size_t jumps_seen_ = 0;
  bool jumped_ = false;  // and no sweep with points came since
  Throttle bad_message_;
  Throttle drops_;
  Throttle losses_;
  Throttle new_maps_;
  std::size_t dropped_told_ = 0;
  std::atomic<bool> stopping_{false};
  std::mutex ending_;
  std::thread thread_;
};

LiveOdometry::LiveOdometry(const NodeOptions& options, const std::string& topic, NodeOutput& output)
    : impl_(std::make_unique<Impl>(options, topic, output)) {}

LiveOdometry::~LiveOdometry() = default;

void LiveOdometry::start() { impl_->start(); }

void LiveOdometry::stop() { impl_->stop(); }

void LiveOdometry::push(LiveQueue::Message message) { impl_->queue->push(std::move(message)); }

void LiveOdometry::note_bad_message(const std::string& why) { impl_->health.note_bad_message(why); }

void LiveOdometry::note_lost(std::size_t total) { impl_->health.note_lost(total); }

void LiveOdometry::reset() { impl_->reset(); }

std::string LiveOdometry::set_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation) {
  if (!position.allFinite() || !(std::abs(orientation.norm() - 1) < 1e-3)) {
    return "expected a finite position and an orientation of length 1";
  }
  SE3 T = SE3::Identity();
  T.linear() = orientation.normalized().toRotationMatrix();
  T.translation() = position;
  impl_->set_pose(T);
  return {};
}

std::string LiveOdometry::set_initial_pose(const std::string& frame, const Eigen::Vector3d& position,
                                           const Eigen::Quaterniond& orientation) {
  const std::string expected = impl_->odom_frame();
  if (frame.empty() || frame_name(frame) == expected) return set_pose(position, orientation);
  return "frame " + frame + ", expected " + expected;
}

LiveOdometry::SavedMap LiveOdometry::save_map(const std::string& file) const {
  try {
    const MapCloud map{impl_->map(), {}, {}};
    if (map.points.empty()) {  // the file may be the map of before the reset
      return {false, file + ": not written, there are no points yet since the start or the last reset", 0};
    }
    write_map(file, map);
    const std::size_t further = impl_->health.new_maps();
    const std::string guesses =
        further == 0 ? "" : fmt::format(" ({} maps, connected by guesses since the sensor was lost)", further + 1);
    return {true, "written: " + std::filesystem::absolute(file).string() + guesses, map.points.size()};
  } catch (const std::exception& error) {
    return {false, error.what(), 0};
  }
}

bool LiveOdometry::set_parameters(const std::map<std::string, ParameterValue>& changes) {
  return impl_->set_parameters(changes);
}

PathMessage LiveOdometry::path() const { return impl_->path(); }

CloudMessage LiveOdometry::local_map() const { return impl_->local_map(); }

StatusMessage LiveOdometry::report() { return impl_->health.report(impl_->queue->counts()); }

}  // namespace rilo
