"""Node and sensor at their own pace: a drive is played in real time, and what the node says at the end is printed.

    RILO_NODE=PREFIX/lib/rilo_ros/rilo_node python3 measure_real_time.py DRIVE [key=value ...]

DRIVE is a folder made by `rilo simulate`, or one of the same layout. The rest are parameters of the node.
"""

import sys
import tempfile
from pathlib import Path

import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry

import ros_bag
from ros_system import Collector, play, running_node, start_roscore, stop, wait_for


def finished(diagnostics, sweeps):
    """The last report, once every sweep was registered or dropped."""
    if not diagnostics.messages:
        return None
    report = {pair.key: pair.value for pair in diagnostics.messages[-1].status[0].values}
    done = int(report.get("sweeps registered", 0)) + int(report.get("sweeps dropped", 0))
    return report if done >= sweeps else None


def measure(drive, parameters, folder):
    bag = folder / "drive.bag"
    sweeps = list(ros_bag.sweeps_of(drive))
    ros_bag.write_bag(bag, sweeps)
    rospy.set_param("/use_sim_time", True)
    rospy.init_node("measure", disable_signals=True)
    odometry, diagnostics = Collector("/odometry", Odometry), Collector("/diagnostics", DiagnosticArray)
    with running_node(parameters):
        odometry.wait_connected()
        diagnostics.wait_connected()
        player = play(bag)
        try:
            return wait_for(lambda: finished(diagnostics, len(sweeps)), "the end of the drive")
        finally:
            stop(player)


def main():
    parameters = {key: yaml.safe_load(value) for key, value in (word.split("=", 1) for word in sys.argv[2:])}
    with tempfile.TemporaryDirectory() as name:
        core = start_roscore(Path(name))
        try:
            report = measure(sys.argv[1], parameters, Path(name))
        finally:
            rospy.signal_shutdown("done")
            stop(core)
    for key in ("messages received", "sweeps registered", "sweeps dropped", "status ok", "ms mean", "ms largest"):
        print(f"{key}: {report[key]}")


if __name__ == "__main__":
    main()
