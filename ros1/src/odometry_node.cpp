#include "odometry_node.hpp"

#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <tf2_eigen/tf2_eigen.h>
#include <utility>

#include "messages.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::ros1 {
namespace {

constexpr const char* kCloudTopic = "points";
constexpr const char* kCloudType = "sensor_msgs/PointCloud2";
constexpr std::uint32_t kQueueOfPublishers = 1000;
constexpr double kReportPeriodS = 1;

std::shared_ptr<LiveQueue> queue_for(const ros::NodeHandle& node, LiveQueueOptions options) {
  options.topic = node.resolveName(kCloudTopic);
  return std::make_shared<LiveQueue>(options);
}

}  // namespace

OdometryNode::OdometryNode(const NodeOptions& options)
    : options_(options), queue_(queue_for(node_, options.queue)), session_(options, queue_) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("odometry", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    health_.report(queue_->counts(), status);
  });
  // By wall time: also while a simulated clock stands still.
  double period_s = kReportPeriodS;
  private_node_.getParam("diagnostic_period", period_s);
  timer_ = node_.createWallTimer(ros::WallDuration(period_s),
                                 [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  advertise();
  thread_ = std::thread([this] { work(); });
}

OdometryNode::~OdometryNode() {
  stopping_ = true;
  queue_->close();
  thread_.join();
}

void OdometryNode::advertise() {
  odometry_publisher_ = node_.advertise<nav_msgs::Odometry>("odometry", kQueueOfPublishers);
  // Who comes late gets the present ones.
  path_publisher_ = node_.advertise<nav_msgs::Path>(
      "path", 1, [this](const ros::SingleSubscriberPublisher& subscriber) { subscriber.publish(path()); });
  map_publisher_ = node_.advertise<sensor_msgs::PointCloud2>(
      "local_map", 1, [this](const ros::SingleSubscriberPublisher& subscriber) { subscriber.publish(local_map()); });
  services_ = {private_node_.advertiseService("reset", &OdometryNode::on_reset, this),
               private_node_.advertiseService("set_pose", &OdometryNode::on_set_pose, this),
               private_node_.advertiseService("save_map", &OdometryNode::on_save_map, this)};
  pose_subscriber_ = node_.subscribe("initialpose", 1, &OdometryNode::on_initial_pose, this);
  // 0: nothing is dropped unseen before it is in our queue, where it is counted.
  cloud_subscriber_ =
      node_.subscribe(kCloudTopic, 0, &OdometryNode::on_cloud, this, ros::TransportHints().tcpNoDelay());
}

void OdometryNode::on_cloud(const topic_tools::ShapeShifter::ConstPtr& message) {
  if (message->getDataType() != kCloudType) {
    const std::string why = "messages of type " + message->getDataType() + ", expected " + kCloudType;
    ROS_ERROR_STREAM_THROTTLE(10, cloud_subscriber_.getTopic() << ": " << why);
    health_.note_bad_message(why);
    return;
  }
  std::string bytes(message->size(), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message->size());
  message->write(stream);
  queue_->push({static_cast<std::int64_t>(ros::Time::now().toNSec()), std::move(bytes)});
}

void OdometryNode::work() {
  try {
    while (!stopping_ && step()) {
    }
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    ros::requestShutdown();
  }
}

// False at the end.
bool OdometryNode::step() {
  try {
    if (!session_.next_sweep()) return false;
    const SourceFigures figures = session_.figures();
    health_.note_source(figures);
    if (!extrinsic_known_ && !find_extrinsic(figures.lidar_frame)) return false;
    process(figures.clock_jumps);
  } catch (const IoError& error) {
    ROS_WARN_STREAM_THROTTLE(10, "left out: " << error.what());
    health_.note_bad_message(error.what());
  }
  return true;
}

// Waits until it is known. False when the node ends before.
bool OdometryNode::find_extrinsic(const std::string& lidar_frame) {
  base_frame_ = options_.base_frame.empty() ? lidar_frame : options_.base_frame;
  extrinsic_known_ = true;
  if (options_.T_base_lidar || base_frame_ == lidar_frame) return true;
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  const std::string wanted = "the transform " + base_frame_ + " to " + lidar_frame;
  health_.note_waiting(wanted + " in TF (or the parameter base_to_lidar)");
  while (!stopping_ && !buffer.canTransform(base_frame_, lidar_frame, ros::Time(0))) {
    ROS_WARN_STREAM_THROTTLE(10, "waiting for " << wanted << ": publish it, or set ~base_to_lidar");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (stopping_) return false;
  const auto T = tf2::transformToEigen(buffer.lookupTransform(base_frame_, lidar_frame, ros::Time(0)));
  health_.note_waiting("");
  const std::lock_guard lock(mutex_);
  session_.set_extrinsic(T);
  return true;
}

void OdometryNode::process(std::size_t clock_jumps) {
  const std::lock_guard lock(mutex_);
  if (clock_jumps > jumps_seen_) {
    jumps_seen_ = clock_jumps;
    ROS_WARN("the stamps went back in time (a bag played again, a clock that was set): the odometry starts anew");
    reset();
  }
  const SweepResult result = session_.register_sweep();
  last_stamp_ns_ = result.stamp_ns;
  health_.note_sweep(result, result.stats.times.total_ms);
  publish(result, session_.last_step_s());
}

void OdometryNode::publish(const SweepResult& result, double step_s) {
  odometry_publisher_.publish(odometry_message(result, step_s, options_.odom_frame, base_frame_));
  if (options_.publish_tf) {
    broadcaster_.sendTransform(transform_message(result, options_.invert_tf, options_.odom_frame, base_frame_));
  }
  const auto due = [&](std::optional<std::int64_t>& last_ns, double period_s, const ros::Publisher& publisher) {
    const double since_s = last_ns ? static_cast<double>(result.stamp_ns - *last_ns) * 1e-9 : period_s;
    if (since_s < period_s || publisher.getNumSubscribers() == 0) return false;
    last_ns = result.stamp_ns;
    return true;
  };
  // With the session held: path() and local_map() would wait for it.
  if (due(path_stamp_ns_, options_.path_period_s, path_publisher_)) {
    path_publisher_.publish(path_message(session_.path(), options_.odom_frame));
  }
  if (due(map_stamp_ns_, options_.local_map_period_s, map_publisher_)) {
    map_publisher_.publish(cloud_message(session_.local_map(), result.stamp_ns, options_.odom_frame));
  }
}

nav_msgs::Path OdometryNode::path() const {
  const std::lock_guard lock(mutex_);
  return path_message(session_.path(), options_.odom_frame);
}

sensor_msgs::PointCloud2 OdometryNode::local_map() const {
  const std::lock_guard lock(mutex_);
  return cloud_message(session_.local_map(), last_stamp_ns_, options_.odom_frame);
}

// With the session held.
void OdometryNode::reset() {
  session_.reset();
  path_stamp_ns_.reset();
  map_stamp_ns_.reset();
  health_.note_reset();
}

bool OdometryNode::on_reset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const std::lock_guard lock(mutex_);
  reset();
  response.success = 1U;
  response.message = "the next sweep starts anew at the identity";
  return true;
}

// What is wrong with the pose, or nothing.
std::string OdometryNode::set_pose(const geometry_msgs::Pose& pose) {
  const Eigen::Quaterniond q(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  const Eigen::Vector3d t(pose.position.x, pose.position.y, pose.position.z);
  if (!t.allFinite() || !(std::abs(q.norm() - 1) < 1e-3)) {
    return "expected a finite position and an orientation of length 1";
  }
  SE3 T = SE3::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = t;
  const std::lock_guard lock(mutex_);
  session_.set_pose(T);
  return {};
}

bool OdometryNode::on_set_pose(rilo_ros::SetPose::Request& request, rilo_ros::SetPose::Response& response) {
  const std::string wrong = set_pose(request.pose);
  response.success = wrong.empty() ? 1U : 0U;
  response.message = wrong.empty() ? "set; path and map moved along" : wrong;
  return true;
}

void OdometryNode::on_initial_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const std::string& frame = message.header.frame_id;
  const std::string wrong = frame.empty() || frame == options_.odom_frame
                                ? set_pose(message.pose.pose)
                                : "frame " + frame + ", expected " + options_.odom_frame;
  if (!wrong.empty()) ROS_WARN_STREAM("initialpose not taken: " << wrong);
}

bool OdometryNode::on_save_map(rilo_ros::SaveMap::Request& request, rilo_ros::SaveMap::Response& response) {
  try {
    std::vector<Eigen::Vector3f> points;
    {
      const std::lock_guard lock(mutex_);
      points = session_.map();
    }
    save_map(request.file, points);
    response.points = points.size();
    response.message = "written: " + std::filesystem::absolute(request.file).string();
    response.success = 1U;
  } catch (const std::exception& error) {
    response.success = 0U;
    response.message = error.what();
  }
  return true;
}

}  // namespace rilo::ros1
