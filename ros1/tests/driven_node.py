"""A node that is driven by messages, what it publishes, and what `rilo run` makes of the same."""

import os
import subprocess
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np

from ros_system import running_node, wait_for

SWEEPS = 30
AT_ONCE = {"queue": 0, "look_ahead": 0}  # every sweep is registered, and at once


def rilo(*arguments):
    subprocess.run([os.environ["RILO_BIN"], *map(str, arguments)], check=True, timeout=250)


def run_offline(bag, out, *arguments):
    """Stamps in ns and poses."""
    rilo("run", bag, "--one-pass", "--out", out, "--no-report", "--quiet", *arguments)
    stamps = [line.split()[0].replace(".", "") for line in open(out / "trajectory.tum") if line[0] != "#"]
    rows = np.loadtxt(out / "poses_lidar.txt").reshape(-1, 3, 4)
    poses = np.zeros((len(rows), 4, 4))
    poses[:, :3] = rows
    poses[:, 3, 3] = 1
    return SimpleNamespace(stamps=[int(stamp) for stamp in stamps], poses=poses)


def connect(topics):
    topics.odometry.wait_connected()
    topics.diagnostics.wait_connected()
    wait_for(lambda: topics.points.get_num_connections() > 0, "the node's subscription")


@contextmanager
def connected_node(topics, parameters=AT_ONCE):
    with running_node(parameters):
        connect(topics)
        yield


def publish(topics, sweeps, done=None):
    """Publishes and waits until so many poses are there."""
    for sweep in sweeps:
        topics.points.publish(sweep)
    topics.odometry.wait(len(sweeps) if done is None else done)


def figures(topics):
    """The values of the newest report."""
    if not topics.diagnostics.messages:
        return {}
    status = topics.diagnostics.messages[-1].status[0]
    return {"level": status.level, "message": status.message, **{pair.key: pair.value for pair in status.values}}


def wait_figure(topics, key, value):
    def reported():
        values = figures(topics)
        return values if values.get(key) == str(value) else None

    return wait_for(reported, f"{key} {value} in the diagnostics")


def matrix(position, q):
    x, y, z, w = q.x, q.y, q.z, q.w
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = position.x, position.y, position.z
    return pose


def poses_of(messages):
    return np.array([matrix(m.pose.pose.position, m.pose.pose.orientation) for m in messages])


def transforms_of(messages, child):
    stamped = [t for m in messages for t in m.transforms if t.child_frame_id == child]
    return stamped, np.array([matrix(t.transform.translation, t.transform.rotation) for t in stamped])
