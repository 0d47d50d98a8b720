#include "odometry_node.hpp"

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <utility>

#include "rilo/node/node_messages.hpp"

namespace rilo::ros1 {
namespace {

constexpr const char* kCloudTopic = "points";
constexpr const char* kCloudType = "sensor_msgs/PointCloud2";
constexpr std::uint32_t kQueueOfPublishers = 1000;

struct Stamps {
  static void set(const NodeStamp& stamp, ros::Time& time) { time = ros::Time(stamp.seconds, stamp.nanoseconds); }
};
using Fields = MessageFields<Stamps>;

template <typename Ros, typename Message>
Ros to_ros(Message&& message) {
  Ros to;
  Fields::copy(std::forward<Message>(message), to);
  return to;
}

void fill(const StatusMessage& message, diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(static_cast<unsigned char>(message.level), message.message);
  for (const auto& [key, value] : message.values) status.add(key, value);
}

}  // namespace

class TransformSource {
 public:
  std::optional<SE3> find(const std::string& base_frame, const std::string& lidar_frame) const {
    if (!buffer_.canTransform(base_frame, lidar_frame, ros::Time(0))) return std::nullopt;
    return Fields::pose_of(buffer_.lookupTransform(base_frame, lidar_frame, ros::Time(0)).transform);
  }

 private:
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
};

OdometryNode::OdometryNode(const NodeOptions& options) : odometry_(options, node_.resolveName(kCloudTopic), *this) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("odometry",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { fill(odometry_.report(), status); });
  // By wall time: also while a simulated clock stands still.
  timer_ = node_.createWallTimer(ros::WallDuration(options.diagnostic_period_s),
                                 [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  advertise();
  // From now on: a bag may have a static transform once, at its beginning.
  if (!options.base_frame.empty() && options.base_to_lidar.empty()) transforms_ = std::make_unique<TransformSource>();
  odometry_.start();
}

OdometryNode::~OdometryNode() { odometry_.stop(); }

void OdometryNode::advertise() {
  odometry_publisher_ = node_.advertise<nav_msgs::Odometry>("odometry", kQueueOfPublishers);
  // Late subscribers get the present ones.
  path_publisher_ =
      node_.advertise<nav_msgs::Path>("path", 1, [this](const ros::SingleSubscriberPublisher& subscriber) {
        subscriber.publish(to_ros<nav_msgs::Path>(odometry_.path()));
      });
  map_publisher_ = node_.advertise<sensor_msgs::PointCloud2>(
      "local_map", 1, [this](const ros::SingleSubscriberPublisher& subscriber) {
        subscriber.publish(to_ros<sensor_msgs::PointCloud2>(odometry_.local_map()));
      });
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
    odometry_.note_bad_message(why);
    return;
  }
  std::string bytes(message->size(), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message->size());
  message->write(stream);
  odometry_.push({static_cast<std::int64_t>(ros::Time::now().toNSec()), std::move(bytes)});
}

void OdometryNode::publish(const OdometryMessage& message) {
  odometry_publisher_.publish(to_ros<nav_msgs::Odometry>(message));
}

void OdometryNode::publish(const TransformMessage& message) {
  broadcaster_.sendTransform(to_ros<geometry_msgs::TransformStamped>(message));
}

void OdometryNode::publish(const PathMessage& message) { path_publisher_.publish(to_ros<nav_msgs::Path>(message)); }

void OdometryNode::publish(CloudMessage&& message) {
  map_publisher_.publish(to_ros<sensor_msgs::PointCloud2>(std::move(message)));
}

bool OdometryNode::path_wanted() const { return path_publisher_.getNumSubscribers() > 0; }

bool OdometryNode::local_map_wanted() const { return map_publisher_.getNumSubscribers() > 0; }

std::optional<SE3> OdometryNode::look_up(const std::string& base_frame, const std::string& lidar_frame) {
  std::optional<SE3> T = transforms_->find(base_frame, lidar_frame);
  if (T) transforms_.reset();
  return T;
}

void OdometryNode::warn(const std::string& text) { ROS_WARN_STREAM(text); }

void OdometryNode::fail(const std::string& why) {
  ROS_FATAL_STREAM(why);
  failed_ = true;
  ros::requestShutdown();
}

bool OdometryNode::on_reset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  odometry_.reset();
  response.success = 1U;
  response.message = "the next sweep is the identity of a new map";
  return true;
}

bool OdometryNode::on_set_pose(rilo_ros::SetPose::Request& request, rilo_ros::SetPose::Response& response) {
  const std::string wrong = odometry_.set_pose(Fields::position_of(request.pose), Fields::orientation_of(request.pose));
  response.success = wrong.empty() ? 1U : 0U;
  response.message = wrong.empty() ? "set; path and map moved along" : wrong;
  return true;
}

void OdometryNode::on_initial_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const geometry_msgs::Pose& pose = message.pose.pose;
  const std::string wrong =
      odometry_.set_initial_pose(message.header.frame_id, Fields::position_of(pose), Fields::orientation_of(pose));
  if (!wrong.empty()) ROS_WARN_STREAM("initialpose not taken: " << wrong);
}

bool OdometryNode::on_save_map(rilo_ros::SaveMap::Request& request, rilo_ros::SaveMap::Response& response) {
  const LiveOdometry::SavedMap saved = odometry_.save_map(request.file);
  response.success = saved.success ? 1U : 0U;
  response.message = saved.message;
  response.points = saved.points;
  return true;
}

}  // namespace rilo::ros1
