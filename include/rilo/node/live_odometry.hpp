// The odometry of a node: messages come in, a thread of its own registers them and hands out what is to be published.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rilo/io/live_queue.hpp"
#include "rilo/node/node_messages.hpp"
#include "rilo/node/node_parameters.hpp"

namespace rilo {

/// Where messages go and transforms come from: ROS 1 or ROS 2. Called by the thread of the odometry.
class NodeOutput {
 public:
  virtual ~NodeOutput() = default;

  virtual void publish(const OdometryMessage& message) = 0;
  virtual void publish(const TransformMessage& message) = 0;
  virtual void publish(const PathMessage& message) = 0;
  /// The local map.
  virtual void publish(CloudMessage&& message) = 0;

  /// Whether there are subscribers.
  virtual bool path_wanted() const = 0;
  virtual bool local_map_wanted() const = 0;

  /// Where the LiDAR sits on the base, when TF knows it by now. Asked until it does.
  virtual std::optional<SE3> look_up(const std::string& base_frame, const std::string& lidar_frame) = 0;

  virtual void warn(const std::string& text) = 0;
  /// The odometry ended with an error: nothing more comes.
  virtual void fail(const std::string& why) = 0;

 protected:
  NodeOutput() = default;
  NodeOutput(const NodeOutput&) = default;
  NodeOutput& operator=(const NodeOutput&) = default;
};

/// Any thread may call any function. What takes a lock waits for the sweep that is being registered.
class LiveOdometry {
 public:
  /// `topic`: for messages to people. `output` must outlive it. @throws std::invalid_argument as Odometry.
  LiveOdometry(const NodeOptions& options, const std::string& topic, NodeOutput& output);
  /// As stop().
  ~LiveOdometry();
  LiveOdometry(const LiveOdometry&) = delete;
  LiveOdometry& operator=(const LiveOdometry&) = delete;

  /// Begins to call the output. Once.
  void start();
  /// The output is not called any more when it returns; what waits in the queue is left.
  void stop();

  /// Never waits.
  void push(LiveQueue::Message message);
  /// For what the transport notices itself.
  void note_bad_message(const std::string& why);
  void note_lost(std::size_t total);

  /// Forgets map, path and motion, and what the messages looked like (frame, period, point times). The next sweep is
  /// the identity, with the present configuration; look_ahead messages are looked at before.
  void reset();

  /// Sets where the base was at the last sweep (before the first: is there at the first). Path and maps move along.
  /// Returns what is wrong with the pose; empty: nothing.
  std::string set_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);
  /// The same for a pose that comes with its frame: only odom_frame (or no name) is understood.
  std::string set_initial_pose(const std::string& frame, const Eigen::Vector3d& position,
                               const Eigen::Quaterniond& orientation);

  struct SavedMap {
    bool success = false;
    std::string message;  ///< where it is, or what went wrong
    std::size_t points = 0;
  };
  /// The map of the run since the last reset, in odom_frame: .ply or .pcd.
  SavedMap save_map(const std::string& file) const;

  /// Takes new values of parameters, all or none; see ParameterChange. True when one of them waits for the next reset.
  /// @throws std::invalid_argument as with_parameters(), and for one that is for the start alone.
  bool set_parameters(const std::map<std::string, ParameterValue>& changes);

  /// As of now, for late subscribers.
  PathMessage path() const;
  CloudMessage local_map() const;

  StatusMessage report();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rilo
