#include <cstdint>

#include "io/ros/mcap_writer.hpp"
#include "io/ros/pose_messages.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

// Definitions as ROS 2 has them, the types they are made of behind them, each after a line of "=".
constexpr std::string_view kSeparator =
    "================================================================================\n";
constexpr std::string_view kHeaderDefinition = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
constexpr std::string_view kTimeDefinition = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
constexpr std::string_view kStampedTransformDefinition =
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
    "geometry_msgs/Transform transform\n";
constexpr std::string_view kTransformDefinition =
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n";
constexpr std::string_view kVector3Definition = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
constexpr std::string_view kQuaternionDefinition =
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";

std::string definition(std::string_view message, std::initializer_list<std::string_view> parts) {
  std::string text(message);
  for (const std::string_view part : parts) text.append(kSeparator).append(part);
  return text;
}

std::string odometry_definition() {
  return definition(
      "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
      "geometry_msgs/TwistWithCovariance twist\n",
      {kHeaderDefinition, kTimeDefinition,
       "MSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance\n",
       "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
       "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n", kQuaternionDefinition,
       "MSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] covariance\n",
       "MSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n", kVector3Definition});
}

std::string tf_definition() {
  return definition("geometry_msgs/TransformStamped[] transforms\n",
                    {kStampedTransformDefinition, kHeaderDefinition, kTimeDefinition, kTransformDefinition,
                     kVector3Definition, kQuaternionDefinition});
}

}  // namespace

void write_mcap(const std::filesystem::path& file, std::span<const SweepResult> results, const RecordingNames& names) {
  constexpr MessageEncoding kCdr = MessageEncoding::kCdr;
  detail::McapWriter writer(file);
  const std::uint16_t odometry =
      writer.add_channel(names.odometry_topic, "nav_msgs/msg/Odometry", odometry_definition());
  const std::uint16_t tf = writer.add_channel(names.tf_topic, "tf2_msgs/msg/TFMessage", tf_definition());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::int64_t stamp_ns = results[i].stamp_ns;
    writer.add_message(odometry, stamp_ns, detail::odometry_message(kCdr, results, i, names).bytes());
    writer.add_message(tf, stamp_ns, detail::transform_message(kCdr, results, i, names).bytes());
  }
  writer.finish();
}

}  // namespace rilo
