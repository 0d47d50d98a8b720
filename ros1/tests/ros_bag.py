"""A simulated drive as PointCloud2 messages, and as a ROS 1 bag."""

from pathlib import Path

import numpy as np
import rosbag
import rospy
from sensor_msgs.msg import PointCloud2, PointField

FIRST_STAMP_NS = 1_700_000_000_250_000_000
PERIOD_S = 0.1
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("time", "<f4")])


def ros_time(stamp_ns):
    return rospy.Time(stamp_ns // 1_000_000_000, stamp_ns % 1_000_000_000)


def sweep_files(drive):
    """Of a folder made by `rilo simulate`, in order."""
    return sorted(Path(drive, "velodyne").glob("*.bin"))


def points_of(file):
    """The points of a sweep, all at time 0."""
    columns = np.fromfile(file, "<f4").reshape(-1, 4)
    points = np.zeros(len(columns), POINT)
    for column, name in enumerate(("x", "y", "z", "intensity")):
        points[name] = columns[:, column]
    return points


def sweep_stamp_ns(index):
    return FIRST_STAMP_NS + round(index * PERIOD_S * 1e9)


def sweeps_of(drive):
    """Messages of a folder made by `rilo simulate`, in order."""
    for index, file in enumerate(sweep_files(drive)):
        points = points_of(file)
        points["time"] = np.fromfile(Path(drive, "times_pt", file.name), "<f4") * np.float32(PERIOD_S)
        yield cloud(points, sweep_stamp_ns(index))


def cloud(points, stamp_ns, frame="velodyne"):
    message = PointCloud2()
    message.header.stamp = ros_time(stamp_ns)
    message.header.frame_id = frame
    message.height = 1
    message.width = len(points)
    message.fields = [PointField(name, POINT.fields[name][1], PointField.FLOAT32, 1) for name in POINT.names]
    message.point_step = POINT.itemsize
    message.row_step = POINT.itemsize * len(points)
    message.data = points.tobytes()
    message.is_dense = True
    return message


def write_bag(file, sweeps, topic="/points"):
    with rosbag.Bag(str(file), "w") as bag:
        for message in sweeps:
            # A driver publishes at the end of the sweep.
            bag.write(topic, message, message.header.stamp + rospy.Duration.from_sec(PERIOD_S))
