#include "odometry_node.hpp"

#include <chrono>
#include <functional>
#include <rclcpp_components/register_node_macro.hpp>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <utility>

#include "parameters.hpp"
#include "rilo/node/node_messages.hpp"

namespace rilo::ros2 {
namespace {

constexpr const char* kCloudTopic = "points";

struct Stamps {
  static void set(const NodeStamp& stamp, builtin_interfaces::msg::Time& time) {
    time.sec = static_cast<std::int32_t>(stamp.seconds);
    time.nanosec = stamp.nanoseconds;
  }
};
using Fields = MessageFields<Stamps>;

// A message that can be handed on within the process without a copy.
template <typename Ros, typename Message>
std::unique_ptr<Ros> to_ros(Message&& message) {
  auto to = std::make_unique<Ros>();
  Fields::copy(std::forward<Message>(message), *to);
  return to;
}

// For topics whose last message waits for those who come late: within a process there is no such thing, and Humble
// refuses the subscription.
template <typename Options>
Options between_processes() {
  Options options;
  options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
  return options;
}

rclcpp::ExecutorOptions executor_of(const rclcpp::NodeOptions& node) {
  rclcpp::ExecutorOptions options;
  options.context = node.context();
  return options;
}

// The message's data stay where they are.
LiveCloud to_live(sensor_msgs::msg::PointCloud2::ConstSharedPtr message) {
  LiveCloud live;
  PointCloud2& cloud = live.message;
  cloud.stamp_ns = std::int64_t{message->header.stamp.sec} * 1'000'000'000 + message->header.stamp.nanosec;
  cloud.frame_id = message->header.frame_id;
  cloud.height = message->height;
  cloud.width = message->width;
  for (const auto& field : message->fields) {
    cloud.fields.push_back({field.name, field.offset, field.datatype, field.count});
  }
  cloud.is_bigendian = message->is_bigendian;
  cloud.point_step = message->point_step;
  cloud.row_step = message->row_step;
  cloud.data = {reinterpret_cast<const char*>(message->data.data()), message->data.size()};
  cloud.is_dense = message->is_dense;
  live.owner = std::move(message);
  return live;
}

diagnostic_msgs::msg::DiagnosticStatus to_ros_status(const StatusMessage& report, const std::string& name) {
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.level = static_cast<unsigned char>(report.level);
  status.name = name;
  status.message = report.message;
  status.hardware_id = "none";
  for (const auto& [key, value] : report.values) {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = value;
  }
  return status;
}

}  // namespace

class TransformSource {
 public:
  explicit TransformSource(rclcpp::Node& node)
      : buffer_(node.get_clock()),
        listener_(buffer_, &node, kOwnThread, tf2_ros::DynamicListenerQoS(), tf2_ros::StaticListenerQoS(),
                  rclcpp::SubscriptionOptions(), between_processes<rclcpp::SubscriptionOptions>()) {}

  std::optional<SE3> find(const std::string& base_frame, const std::string& lidar_frame) const {
    std::string why_not;  // asked for, it is not printed
    if (!buffer_.canTransform(base_frame, lidar_frame, tf2::TimePointZero, &why_not)) return std::nullopt;
    return Fields::pose_of(buffer_.lookupTransform(base_frame, lidar_frame, tf2::TimePointZero).transform);
  }

 private:
  static constexpr bool kOwnThread = true;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

OdometryNode::OdometryNode(const rclcpp::NodeOptions& options)
    : Node("rilo", options),
      broadcaster_(*this),
      odometry_(declare_options(*this), get_node_topics_interface()->resolve_topic_name(kCloudTopic), *this),
      cloud_executor_(executor_of(options)) {
  advertise();
  parameters_callback_ = add_on_set_parameters_callback(
      [this](const std::vector<rclcpp::Parameter>& parameters) { return on_parameters(parameters); });
  // From now on: a bag may have a static transform once, at its beginning.
  if (!get_parameter("base_frame").as_string().empty() && get_parameter("base_to_lidar").as_double_array().empty()) {
    transforms_ = std::make_unique<TransformSource>(*this);
  }
  odometry_.start();
  subscribe();
}

OdometryNode::~OdometryNode() {
  ended_.set_value();
  cloud_executor_.cancel();
  cloud_thread_.join();
  odometry_.stop();
}

void OdometryNode::advertise() {
  using std_srvs::srv::Trigger;
  odometry_publisher_ = create_publisher<nav_msgs::msg::Odometry>("odometry", rclcpp::QoS(100));
  diagnostics_publisher_ = create_publisher<diagnostic_msgs::msg::DiagnosticArray>("/diagnostics", rclcpp::QoS(10));
  const auto latched = rclcpp::QoS(1).transient_local();
  const auto options = between_processes<rclcpp::PublisherOptions>();
  path_publisher_ = create_publisher<nav_msgs::msg::Path>("path", latched, options);
  map_publisher_ = create_publisher<PointCloud2>("local_map", latched, options);

  services_.push_back(create_service<Trigger>(
      "~/reset", [this](Trigger::Request::SharedPtr /*request*/, Trigger::Response::SharedPtr response) {
        odometry_.reset();
        publish_present();
        response->success = true;
        response->message = "the next sweep is the identity of a new map";
      }));
  services_.push_back(create_service<rilo_ros2::srv::SetPose>(
      "~/set_pose", [this](rilo_ros2::srv::SetPose::Request::SharedPtr request,
                           rilo_ros2::srv::SetPose::Response::SharedPtr response) {
        const std::string wrong =
            odometry_.set_pose(Fields::position_of(request->pose), Fields::orientation_of(request->pose));
        if (wrong.empty()) publish_present();
        response->success = wrong.empty();
        response->message = wrong.empty() ? "set; path and map moved along" : wrong;
      }));
  services_.push_back(create_service<rilo_ros2::srv::SaveMap>(
      "~/save_map", [this](rilo_ros2::srv::SaveMap::Request::SharedPtr request,
                           rilo_ros2::srv::SaveMap::Response::SharedPtr response) {
        const LiveOdometry::SavedMap saved = odometry_.save_map(request->file);
        response->success = saved.success;
        response->message = saved.message;
        response->points = saved.points;
      }));
  // By wall time: also while a simulated clock stands still.
  const std::chrono::duration<double> period(get_parameter("diagnostic_period").as_double());
  timers_.push_back(create_wall_timer(period, [this] { report(); }));
  timers_.push_back(create_wall_timer(std::chrono::milliseconds(500), [this] { serve_newcomers(); }));
}

void OdometryNode::subscribe() {
  pose_subscription_ = create_subscription<geometry_msgs::msg::PoseWithCovarianceStamped>(
      "initialpose", rclcpp::QoS(1),
      [this](const geometry_msgs::msg::PoseWithCovarianceStamped& message) { on_initial_pose(message); });
  // On a thread of its own: a map that is saved does not keep sweeps waiting, whatever the container. A second group in
  // the container's executor would abort it when the node is unloaded: Humble forgets to take out its guard condition.
  cloud_group_ = create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false);
  rclcpp::SubscriptionOptions options;
  options.callback_group = cloud_group_;
  options.qos_overriding_options = rclcpp::QosOverridingOptions::with_default_policies();
  options.event_callbacks.message_lost_callback = [this](rclcpp::QOSMessageLostInfo& lost) {
    odometry_.note_lost(lost.total_count);
  };
  // Where no sweep is to be dropped, none is pushed out while a thread of the executor is awaited.
  constexpr std::size_t kDepthOfAll = 1000;
  auto qos = rclcpp::SensorDataQoS();
  if (get_parameter("queue").as_int() == 0) qos.keep_last(kDepthOfAll);
  cloud_subscription_ = create_subscription<PointCloud2>(
      kCloudTopic, qos, [this](PointCloud2::ConstSharedPtr message) { on_cloud(std::move(message)); }, options);
  cloud_executor_.add_callback_group(cloud_group_, get_node_base_interface());
  // Until the future, not until cancel(): that would be forgotten if it came before the thread has begun.
  cloud_thread_ = std::thread([this] { cloud_executor_.spin_until_future_complete(ended_.get_future()); });
}

void OdometryNode::on_cloud(PointCloud2::ConstSharedPtr message) {
  odometry_.push({now().nanoseconds(), to_live(std::move(message))});
}

void OdometryNode::on_initial_pose(const geometry_msgs::msg::PoseWithCovarianceStamped& message) {
  const auto& pose = message.pose.pose;
  const std::string wrong =
      odometry_.set_initial_pose(message.header.frame_id, Fields::position_of(pose), Fields::orientation_of(pose));
  if (wrong.empty()) {
    publish_present();
  } else {
    warn("initialpose not taken: " + wrong);
  }
}

rcl_interfaces::msg::SetParametersResult OdometryNode::on_parameters(const std::vector<rclcpp::Parameter>& parameters) {
  rcl_interfaces::msg::SetParametersResult result;
  try {
    result.successful = true;
    const auto changes = own_parameters(parameters);
    if (!changes.empty() && odometry_.set_parameters(changes)) {
      RCLCPP_INFO(get_logger(), "a key of the configuration has changed: it counts from the next reset on");
    }
  } catch (const std::invalid_argument& error) {
    result.successful = false;
    result.reason = error.what();
  }
  return result;
}

void OdometryNode::report() {
  auto message = std::make_unique<diagnostic_msgs::msg::DiagnosticArray>();
  message->header.stamp = now();
  message->status.push_back(to_ros_status(odometry_.report(), std::string(get_name()) + ": odometry"));
  diagnostics_publisher_->publish(std::move(message));
}

// Path and map have moved or are gone: so is what waits for those who come late.
void OdometryNode::publish_present() {
  publish(odometry_.path());
  publish(odometry_.local_map());
}

// Late subscribers get the present ones, not those of the last subscription.
void OdometryNode::serve_newcomers() {
  const std::size_t path_listeners = path_publisher_->get_subscription_count();
  const std::size_t map_listeners = map_publisher_->get_subscription_count();
  if (path_listeners > path_listeners_) publish(odometry_.path());
  if (map_listeners > map_listeners_) publish(odometry_.local_map());
  path_listeners_ = path_listeners;
  map_listeners_ = map_listeners;
}

void OdometryNode::publish(const OdometryMessage& message) {
  odometry_publisher_->publish(to_ros<nav_msgs::msg::Odometry>(message));
}

void OdometryNode::publish(const TransformMessage& message) {
  broadcaster_.sendTransform(*to_ros<geometry_msgs::msg::TransformStamped>(message));
}

void OdometryNode::publish(const PathMessage& message) {
  path_publisher_->publish(to_ros<nav_msgs::msg::Path>(message));
}

void OdometryNode::publish(CloudMessage&& message) { map_publisher_->publish(to_ros<PointCloud2>(std::move(message))); }

bool OdometryNode::path_wanted() const { return path_publisher_->get_subscription_count() > 0; }

bool OdometryNode::local_map_wanted() const { return map_publisher_->get_subscription_count() > 0; }

std::optional<SE3> OdometryNode::look_up(const std::string& base_frame, const std::string& lidar_frame) {
  std::optional<SE3> T = transforms_->find(base_frame, lidar_frame);
  if (T) transforms_.reset();
  return T;
}

void OdometryNode::warn(const std::string& text) { RCLCPP_WARN(get_logger(), "%s", text.c_str()); }

void OdometryNode::fail(const std::string& why) {
  RCLCPP_FATAL(get_logger(), "%s", why.c_str());
  failed_ = true;
  rclcpp::shutdown(get_node_base_interface()->get_context(), why);
}

}  // namespace rilo::ros2

RCLCPP_COMPONENTS_REGISTER_NODE(rilo::ros2::OdometryNode)
