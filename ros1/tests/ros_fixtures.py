"""roscore, a drive and the topics of the node, for all tests."""

from types import SimpleNamespace

import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

import ros_bag
from driven_node import SWEEPS, rilo, run_offline
from ros_system import Collector, start_roscore, stop


@pytest.fixture(scope="session")
def ros(tmp_path_factory):
    core = start_roscore(tmp_path_factory.mktemp("ros"))
    rospy.set_param("/use_sim_time", True)
    rospy.init_node("test", disable_signals=True)
    yield
    rospy.signal_shutdown("done")
    stop(core)


@pytest.fixture(scope="session")
def drive(tmp_path_factory):
    """Messages, a bag of them, and what `rilo run` makes of the bag."""
    folder = tmp_path_factory.mktemp("drive")
    rilo("simulate", "--out", folder / "drive", "--sensor", "vlp16", "--sweeps", SWEEPS, "--start", 4, "--quiet")
    sweeps = list(ros_bag.sweeps_of(folder / "drive"))
    bag = folder / "drive.bag"
    ros_bag.write_bag(bag, sweeps)
    offline = run_offline(bag, folder / "results")
    return SimpleNamespace(sweeps=sweeps, bag=bag, folder=folder, offline=offline)


@pytest.fixture
def topics(ros):
    topics = SimpleNamespace(
        odometry=Collector("/odometry", Odometry), tf=Collector("/tf", TFMessage),
        diagnostics=Collector("/diagnostics", DiagnosticArray),
        points=rospy.Publisher("/points", PointCloud2, queue_size=1000))
    yield topics
    for collector in (topics.odometry, topics.tf, topics.diagnostics):
        collector.subscriber.unregister()
    topics.points.unregister()
