"""roscore, the node and what it publishes, for the tests. Every wait is for a condition, with a generous end."""

import os
import signal
import socket
import subprocess
import time
import xmlrpc.client
from contextlib import contextmanager

import rospy

PATIENCE_S = 120


def wait_for(condition, what):
    """The first true value of `condition`."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"waited {PATIENCE_S} s in vain for {what}")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def stop(process):
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def play(bag, *flags):
    """The player, with the clock. It stays until it is stopped: leaving, it would lose messages still on their way."""
    return subprocess.Popen(["rosbag", "play", "--clock", "--quiet", "--keep-alive", "--wait-for-subscribers", *flags,
                             str(bag)], stdin=subprocess.DEVNULL)


def start_roscore(folder):
    """roscore on a port that nobody uses; sets the environment so that all who are started later find it."""
    os.environ.update(ROS_HOME=str(folder), ROS_LOG_DIR=str(folder), ROS_IP="127.0.0.1", PYTHONUNBUFFERED="1")
    os.environ.pop("ROS_HOSTNAME", None)
    for _ in range(5):  # somebody may take the port before roscore does
        port = free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        log = open(folder / f"roscore_{port}.log", "w")
        core = subprocess.Popen(["roscore", "-p", str(port)], stdout=log, stderr=subprocess.STDOUT)

        def up():
            try:
                code, _, nodes = xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"]).lookupNode("/t", "/rosout")
                return core.poll() is not None or code == 1
            except OSError:
                return core.poll() is not None

        wait_for(up, "roscore")
        if core.poll() is None:
            return core
    raise AssertionError("roscore does not start: see " + log.name)


class Collector:
    """All messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=10000)

    def wait_connected(self):
        wait_for(lambda: self.subscriber.get_num_connections() > 0, f"a publisher of {self.subscriber.name}")
        return self

    def wait(self, count):
        wait_for(lambda: len(self.messages) >= count, f"{count} messages on {self.subscriber.name}")
        return self.messages


def first_of(topic, kind):
    """What a new subscriber gets first."""
    collector = Collector(topic, kind)
    try:
        return collector.wait(1)[0]
    finally:
        collector.subscriber.unregister()


def delete_parameters(name):
    """All of a node; it may have had none."""
    if rospy.has_param(name):
        rospy.delete_param(name)


@contextmanager
def running_node(parameters=None, remaps=(), name="rilo", binary=os.environ.get("RILO_NODE", "rilo_node")):
    """The node with parameters of its own; they are gone afterwards."""
    full = "/" + name
    for key, value in (parameters or {}).items():
        rospy.set_param(f"{full}/{key}", value)
    process = subprocess.Popen([binary, f"__name:={name}", *remaps])
    try:
        yield process
    finally:
        stop(process)
        delete_parameters(full)
