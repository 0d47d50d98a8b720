"""ros2 launch rilo_ros2 odometry.launch.py points:=/velodyne_points base_frame:=base_link rviz:=true"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue

SHARE = Path(get_package_share_directory("rilo_ros2"))
CONTAINER_OF_ITS_OWN = "own"


def flag(text):
    return {"true": True, "false": False}[text.lower()]


def numbers(text):
    inner = text.strip("[] ")
    return [float(number) for number in inner.split(",")] if inner else []


EXPECTED = {flag: "true or false", int: "a whole number", numbers: "a list of numbers", str: "a text"}


def taken(given, name, kind):
    try:
        return kind(given[name])
    except (KeyError, ValueError):
        raise ValueError(f"{name}: expected {EXPECTED[kind]}, found {given[name]}") from None


# Parameters of the node: what is left empty is as the parameter file says.
PARAMETERS = {
    "config": (str, "YAML configuration, as for rilo run --config"),
    "calibration": (str, "calibration.yaml of a rilo run with this sensor"),
    "odom_frame": (str, "where the base was at the first sweep"),
    "base_frame": (str, "the robot's frame; empty: the LiDAR's own"),
    "base_to_lidar": (numbers, "[x, y, z, yaw, pitch, roll] (m, rad) or [x, y, z, qx, qy, qz, qw]; empty: from TF"),
    "publish_tf": (flag, "odom_frame to base_frame on /tf"),
    "invert_tf": (flag, "base_frame becomes the parent of odom_frame"),
    "queue": (int, "sweeps that may wait; 0: all, none is dropped"),
    "use_sim_time": (flag, "time from /clock, as ros2 bag play --clock gives it"),
}
ARGUMENTS = {
    "points": ("points", "topic of the sweeps, sensor_msgs/msg/PointCloud2"),
    "parameters": (str(SHARE / "config" / "odometry.yaml"), "parameter file"),
    "reliable": ("false", "ask for messages again that got lost; the publisher must be reliable, too"),
    "container": ("", f"load into this running container; {CONTAINER_OF_ITS_OWN}: into a new one; empty: no component"),
    "rviz": ("false", "start RViz 2"),
}


def full_name(topic, namespace):
    """As the node resolves it in a namespace that was pushed around this file: two robots have one each."""
    return topic if topic.startswith("/") else "/" + "/".join(filter(None, [namespace.strip("/"), topic]))


def node_parameters(given, namespace):
    values = {name: taken(given, name, kind) for name, (kind, _) in PARAMETERS.items() if given[name] != ""}
    # A plain text would be read as YAML: a frame "1" as a number.
    values = {name: ParameterValue(value, value_type=str) if isinstance(value, str) else value
              for name, value in values.items()}
    if taken(given, "reliable", flag):
        topic = full_name(given["points"], namespace)
        values[f"qos_overrides.{topic}.subscription.reliability"] = "reliable"
        values[f"qos_overrides.{topic}.subscription.history"] = "keep_last"
        values[f"qos_overrides.{topic}.subscription.depth"] = 100
    return [given["parameters"], values]


def odometry(given, namespace):
    parameters, remappings = node_parameters(given, namespace), [("points", given["points"])]
    container = given["container"]
    if container == "":
        return Node(package="rilo_ros2", executable="rilo_node", name="rilo", output="screen",
                    parameters=parameters, remappings=remappings)
    component = ComposableNode(package="rilo_ros2", plugin="rilo::ros2::OdometryNode", name="rilo",
                               parameters=parameters, remappings=remappings,
                               extra_arguments=[{"use_intra_process_comms": True}])
    if container == CONTAINER_OF_ITS_OWN:
        return ComposableNodeContainer(package="rclcpp_components", executable="component_container",
                                       name="rilo_container", namespace="", output="screen",
                                       composable_node_descriptions=[component])
    return LoadComposableNodes(target_container=container, composable_node_descriptions=[component])


def rviz():
    return Node(package="rviz2", executable="rviz2", name="rviz2",
                arguments=["-d", str(SHARE / "rviz" / "odometry.rviz")])


def actions(context):
    given = {name: context.launch_configurations[name] for name in (*PARAMETERS, *ARGUMENTS)}
    namespace = context.launch_configurations.get("ros_namespace", "")
    return [odometry(given, namespace)] + ([rviz()] if taken(given, "rviz", flag) else [])


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value="", description=meaning)
                for name, (_, meaning) in PARAMETERS.items()]
    declared += [DeclareLaunchArgument(name, default_value=default, description=meaning)
                 for name, (default, meaning) in ARGUMENTS.items()]
    return LaunchDescription([*declared, OpaqueFunction(function=actions)])
