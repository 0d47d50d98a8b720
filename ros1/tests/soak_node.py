"""A long run of the node: a drive there and back as often as it takes, and what its process holds on the way.

    RILO_NODE=PREFIX/lib/rilo_ros/rilo_node python3 soak_node.py DRIVE [SWEEPS [EVERY]]

DRIVE is a folder made by `rilo simulate`, with or without times. A sweep is sent when the one but one before it has its
pose, so that the node is never idle and drops nothing. Prints a table: milliseconds a sweep (everything, transport
included), resident memory, open files, threads; exit code 1 if the last tenth of the run holds more files or threads than
the tenth after the first, or more memory than the published path, 250 bytes a pose, and 5 MiB. No map is kept for save_map,
which grows with every place.
"""

import sys
import tempfile
import time
from pathlib import Path

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2

import ros_bag
from ros_system import running_node, start_roscore, stop, wait_for

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from process_watch import print_growth, state_of, table, there_and_back  # noqa: E402

PATH_MB = 250 / 2**20


def sweeps_there_and_back(drive):
    """Messages without end; the sweeps are motion-compensated, as if each were taken at one instant."""
    for index, file in enumerate(there_and_back(ros_bag.sweep_files(drive))):
        yield ros_bag.cloud(ros_bag.points_of(file), ros_bag.sweep_stamp_ns(index))


def soak(drive, sweeps, every):
    rospy.init_node("soak", disable_signals=True)
    done = [0]

    def count(_):
        done[0] += 1

    odometry = rospy.Subscriber("/odometry", Odometry, count, queue_size=100)
    publisher = rospy.Publisher("/points", PointCloud2, queue_size=4)
    rows = []
    with running_node({"queue": 0, "look_ahead": 0, "point_times": "none", "map_voxel": 0}) as node:
        wait_for(lambda: publisher.get_num_connections() > 0 and odometry.get_num_connections() > 0, "the node")
        source = sweeps_there_and_back(drive)
        last = time.monotonic()
        for sent in range(1, sweeps + 1):
            publisher.publish(next(source))
            wait_for(lambda sent=sent: done[0] >= sent - 2, f"the pose of sweep {sent - 2}")
            if sent % every == 0:
                now = time.monotonic()
                rows.append((sent, (now - last) * 1e3 / every, state_of(node.pid)))
                print(list(table(rows))[-1], flush=True)
                last = now
        wait_for(lambda: done[0] >= sweeps, "the last pose")
    return rows


def main():
    sweeps = int(sys.argv[2]) if len(sys.argv) > 2 else 20000
    every = int(sys.argv[3]) if len(sys.argv) > 3 else 500
    with tempfile.TemporaryDirectory() as name:
        core = start_roscore(Path(name))
        try:
            rows = soak(sys.argv[1], sweeps, every)
        finally:
            rospy.signal_shutdown("done")
            stop(core)
    memory, files, threads = print_growth(rows)
    sys.exit(int(memory > 5.0 + PATH_MB * sweeps or files > 0 or threads > 0))


if __name__ == "__main__":
    main()
