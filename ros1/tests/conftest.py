"""The installed node on a real roscore. Where ROS 1 is not there, no test is."""

from importlib.util import find_spec

NEEDED = ("rospy", "rosbag", "roslaunch", "tf2_msgs", "nav_msgs", "diagnostic_msgs", "std_srvs")
if all(find_spec(module) for module in NEEDED):
    from ros_fixtures import drive, ros, topics  # noqa: F401
else:
    collect_ignore_glob = ["test_*.py"]
