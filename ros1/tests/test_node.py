"""The installed node on a real roscore: poses against `rilo run`, services, frames, and what goes wrong on a robot."""

import os
import subprocess
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest

for module in ("rospy", "rosbag", "roslaunch", "tf2_msgs", "nav_msgs", "diagnostic_msgs", "std_srvs"):
    pytest.importorskip(module)

import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Pose, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry, Path
from rilo_ros.srv import SaveMap, SetPose
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

import ros_bag
from ros_system import Collector, delete_parameters, first_of, play, running_node, start_roscore, stop, wait_for

SWEEPS = 30
AT_ONCE = {"queue": 0, "look_ahead": 0}  # every sweep is registered, and at once
EXTRINSIC = [1.2, -0.3, 1.7, 0.4, 0.02, -0.01]  # x, y, z, yaw, pitch, roll of the LiDAR on the base


def rilo(*arguments):
    subprocess.run([os.environ["RILO_BIN"], *map(str, arguments)], check=True, timeout=250)


@pytest.fixture(scope="module")
def ros(tmp_path_factory):
    core = start_roscore(tmp_path_factory.mktemp("ros"))
    rospy.set_param("/use_sim_time", True)
    rospy.init_node("test", disable_signals=True)
    yield
    rospy.signal_shutdown("done")
    stop(core)


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Messages, a bag of them, and what `rilo run` makes of the bag."""
    folder = tmp_path_factory.mktemp("drive")
    rilo("simulate", "--out", folder / "drive", "--sensor", "vlp16", "--sweeps", SWEEPS, "--start", 4, "--quiet")
    sweeps = list(ros_bag.sweeps_of(folder / "drive"))
    bag = folder / "drive.bag"
    ros_bag.write_bag(bag, sweeps)
    offline = run_offline(bag, folder / "results")
    return SimpleNamespace(sweeps=sweeps, bag=bag, folder=folder, offline=offline)


def run_offline(bag, out, *arguments):
    """Stamps in ns and poses."""
    rilo("run", bag, "--one-pass", "--out", out, "--no-report", "--quiet", *arguments)
    stamps = [line.split()[0].replace(".", "") for line in open(out / "trajectory.tum") if line[0] != "#"]
    rows = np.loadtxt(out / "poses_lidar.txt").reshape(-1, 3, 4)
    poses = np.zeros((len(rows), 4, 4))
    poses[:, :3] = rows
    poses[:, 3, 3] = 1
    return SimpleNamespace(stamps=[int(stamp) for stamp in stamps], poses=poses)


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


def extrinsic_matrix():
    x, y, z, yaw, pitch, roll = EXTRINSIC
    cy, sy, cp, sp, cr, sr = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    pose = np.eye(4)
    pose[:3, :3] = (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
                    @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))
    pose[:3, 3] = x, y, z
    return pose


def test_the_bag_that_a_run_leaves_is_read_by_ros(drive):
    file = drive.folder / "results" / "trajectory.bag"
    if not file.exists():
        pytest.skip("built without librosbag-storage")
    with rosbag.Bag(str(file)) as bag:
        messages = [message for _, message, _ in bag.read_messages(["/odometry"])]
        transforms = [message.transforms[0] for _, message, _ in bag.read_messages(["/tf"])]
    assert [m.header.stamp.to_nsec() for m in messages] == drive.offline.stamps
    assert [t.header.stamp.to_nsec() for t in transforms] == drive.offline.stamps
    np.testing.assert_allclose(poses_of(messages), drive.offline.poses, rtol=0, atol=1e-9)


def test_a_played_bag_gives_the_trajectory_of_an_offline_run(topics, drive):
    with connected_node(topics, {"queue": 0}):
        player = play(drive.bag, "-r", "3")
        try:
            messages = topics.odometry.wait(SWEEPS)
            report = wait_figure(topics, "sweeps registered", SWEEPS)
        finally:
            stop(player)
        assert [m.header.stamp.to_nsec() for m in messages] == drive.offline.stamps
        np.testing.assert_allclose(poses_of(messages), drive.offline.poses, rtol=0, atol=1e-9)
        assert np.linalg.norm(drive.offline.poses[-1, :3, 3]) > 5  # it did drive
        assert (report["sweeps dropped"], report["messages that cannot be read"]) == ("0", "0")
        assert float(report["ms mean"]) > 0
        # Simulated time: reports carry the clock of the bag, which runs on behind its end, not that of the wall.
        clock = [m.header.stamp.to_nsec() for m in topics.diagnostics.messages]
        assert all(t == 0 or drive.offline.stamps[0] - 1e9 < t < drive.offline.stamps[-1] + 1e13 for t in clock)
        assert max(clock) > 0
        # Who comes late gets the path and the local map.
        path = first_of("/path", Path)
        assert len(path.poses) == SWEEPS and path.header.frame_id == "odom"
        local_map = first_of("/local_map", PointCloud2)
        assert local_map.width > 1000 and local_map.header.frame_id == "odom"


def test_covariances_are_in_the_order_of_ros(topics, drive):
    with connected_node(topics):
        publish(topics, drive.sweeps[:6])
        message = topics.odometry.messages[-1]
    pose = np.reshape(message.pose.covariance, (6, 6))
    assert np.all(np.linalg.eigvalsh(pose) > 0)
    assert np.allclose(pose, pose.T)
    twist = np.reshape(message.twist.covariance, (6, 6))
    # The street is straight: forward is forward, position before rotation in both.
    assert message.twist.twist.linear.x > 2 > abs(message.twist.twist.linear.y)
    assert np.trace(twist) == pytest.approx(np.trace(pose) * 100, rel=0.05)  # over a period of 0.1 s
    assert message.child_frame_id == "velodyne"


def test_keys_of_the_configuration_and_a_file_are_taken(topics, drive, tmp_path):
    config = tmp_path / "config.yaml"
    config.write_text("map:\n  voxel_m: 0.7\npreprocess:\n  source_points: 3000\n")
    offline = run_offline(drive.bag, tmp_path / "out", "--config", config, "--set", "icp.max_iterations=7",
                          "--count", 6)
    assert np.abs(offline.poses - drive.offline.poses[:6]).max() > 1e-6
    with connected_node(topics, {"config": str(config), "icp": {"max_iterations": 7}, "queue": 0, "look_ahead": 0}):
        publish(topics, drive.sweeps[:6])
    np.testing.assert_allclose(poses_of(topics.odometry.messages), offline.poses, rtol=0, atol=1e-9)


@pytest.mark.parametrize("parameters, told", [
    ({"icp": {"max_iteration": 7}}, b"icp.max_iterations"),
    ({"queue": -1}, b"parameter queue"),
    ({"publish_tf": "perhaps"}, b"parameter publish_tf"),
    ({"base_to_lidar": [1, 2]}, b"parameter base_to_lidar"),
    ({"config": "nowhere.yaml"}, b"nowhere.yaml"),
])
def test_wrong_parameters_end_the_node(ros, parameters, told):
    for key, value in parameters.items():
        rospy.set_param(f"/wrong/{key}", value)
    node = subprocess.run([os.environ["RILO_NODE"], "__name:=wrong"], capture_output=True, timeout=100)
    rospy.delete_param("/wrong")
    assert node.returncode == 1
    assert told in node.stderr + node.stdout


def test_reset_starts_anew_at_the_identity(topics, drive):
    with connected_node(topics):
        publish(topics, drive.sweeps[:5])
        assert rospy.ServiceProxy("/rilo/reset", Trigger)().success
        publish(topics, drive.sweeps[5:8], 8)
        report = wait_figure(topics, "sweeps registered", 8)
    assert report["resets"] == "1" and report["status initialising"] == "2"
    poses = poses_of(topics.odometry.messages)
    assert np.array_equal(poses[5], np.eye(4)) and not np.array_equal(poses[4], np.eye(4))


def test_set_pose_moves_what_follows_and_the_path(topics, drive):
    wanted = Pose()
    wanted.position.x, wanted.position.y, wanted.position.z = 100, -50, 3
    wanted.orientation.z, wanted.orientation.w = np.sin(0.6), np.cos(0.6)
    with connected_node(topics):
        publish(topics, drive.sweeps[:4])
        set_pose = rospy.ServiceProxy("/rilo/set_pose", SetPose)
        assert set_pose(wanted).success
        publish(topics, drive.sweeps[4:6], 6)
        path = first_of("/path", Path)
        refused = set_pose(Pose())  # the quaternion is zero
        assert not refused.success and "length 1" in refused.message
        # As rviz' tool sets it.
        tool = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        wait_for(lambda: tool.get_num_connections() > 0, "the node's subscription to initialpose")
        message = PoseWithCovarianceStamped()
        message.header.frame_id = "odom"
        message.pose.pose.orientation.w = 1
        tool.publish(message)
        wait_for(lambda: abs(first_of("/path", Path).poses[5].pose.position.x) < 1e-9, "the pose of initialpose")
    poses, offline = poses_of(topics.odometry.messages), drive.offline.poses
    np.testing.assert_allclose(poses[:4], offline[:4], rtol=0, atol=1e-9)
    start = matrix(wanted.position, wanted.orientation) @ np.linalg.inv(offline[3])
    np.testing.assert_allclose(poses[4:], start @ offline[4:6], rtol=0, atol=1e-9)
    np.testing.assert_allclose([matrix(p.pose.position, p.pose.orientation) for p in path.poses], start @ offline[:6],
                               rtol=0, atol=1e-9)


def test_the_map_is_saved(topics, drive, tmp_path):
    with connected_node(topics):
        publish(topics, drive.sweeps[:4])
        save_map = rospy.ServiceProxy("/rilo/save_map", SaveMap)
        for name, counted in (("map.ply", "element vertex {}"), ("map.pcd", "POINTS {}")):
            answer = save_map(str(tmp_path / name))
            assert answer.success and answer.points > 1000
            header = (tmp_path / name).read_bytes()[:600].decode("ascii", "replace")
            assert counted.format(answer.points) in header.replace("  ", " ")
        for wrong in (tmp_path / "nowhere" / "map.ply", tmp_path / "map.txt"):
            answer = save_map(str(wrong))
            assert not answer.success and str(wrong) in answer.message and not wrong.exists()


def test_a_queue_of_one_keeps_the_freshest_sweep(topics, drive):
    """While the transform is missing the node takes no further sweep: what comes meanwhile must be dropped."""
    with connected_node(topics, {"queue": 1, "look_ahead": 0, "base_frame": "base_link"}):
        for sweep in drive.sweeps[:10]:
            topics.points.publish(sweep)
        report = wait_figure(topics, "messages received", 10)
        assert int(report["sweeps dropped"]) in (8, 9)  # one or none was taken before the second came
        waiting = wait_for(lambda: "waiting for" in figures(topics)["message"] and figures(topics), "the complaint")
        assert waiting["level"] == 2 and "base_link" in waiting["message"]
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "base_link", "velodyne"
        transform.transform.translation.z, transform.transform.rotation.w = 1.5, 1
        static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        static.publish(TFMessage([transform]))
        expected = 10 - int(report["sweeps dropped"])
        messages = topics.odometry.wait(expected)
        report = wait_figure(topics, "sweeps registered", expected)
        static.unregister()
    assert int(report["sweeps dropped"]) == 10 - expected
    assert messages[-1].header.stamp.to_nsec() == drive.offline.stamps[9]
    assert messages[-1].child_frame_id == "base_link"


def test_a_message_that_cannot_be_read_is_reported_and_left_out(topics, drive):
    broken = [ros_bag.cloud(np.zeros(10, ros_bag.POINT), ros_bag.FIRST_STAMP_NS) for _ in range(3)]
    broken[0].fields = broken[0].fields[1:]
    broken[1].is_bigendian = True
    broken[2].data = broken[2].data[:50]
    with connected_node(topics):
        publish(topics, drive.sweeps[:2])
        for sweep in broken:
            topics.points.publish(sweep)
        publish(topics, drive.sweeps[2:5], 5)
        report = wait_figure(topics, "sweeps registered", 5)
    assert report["messages that cannot be read"] == "3"
    assert "message 5 of /points" in report["last that cannot be read"]
    assert any("cannot be read" in m.status[0].message for m in topics.diagnostics.messages)
    np.testing.assert_allclose(poses_of(topics.odometry.messages), drive.offline.poses[:5], rtol=0, atol=1e-9)


def test_a_jump_back_in_time_starts_anew(topics, drive):
    with connected_node(topics):
        publish(topics, drive.sweeps[12:15])
        publish(topics, drive.sweeps[:3], 6)
        report = wait_figure(topics, "sweeps registered", 6)
    assert (report["jumps back in time"], report["resets"]) == ("1", "1")
    np.testing.assert_allclose(poses_of(topics.odometry.messages)[3:], drive.offline.poses[:3], rtol=0, atol=1e-9)


def test_tf_of_the_lidar(topics, drive):
    with connected_node(topics):
        topics.tf.wait_connected()
        publish(topics, drive.sweeps[:4])
        topics.tf.wait(4)
    stamped, transforms = transforms_of(topics.tf.messages, "velodyne")
    assert {t.header.frame_id for t in stamped} == {"odom"}
    assert [t.header.stamp.to_nsec() for t in stamped] == drive.offline.stamps[:4]
    np.testing.assert_allclose(transforms, drive.offline.poses[:4], rtol=0, atol=1e-9)


def test_tf_of_the_base_inverted_and_with_other_names(topics, drive):
    parameters = {"base_frame": "robot", "odom_frame": "lidar_odom", "base_to_lidar": EXTRINSIC, "invert_tf": True}
    with connected_node(topics, {**AT_ONCE, **parameters}):
        topics.tf.wait_connected()
        publish(topics, drive.sweeps[:4])
        topics.tf.wait(4)
    extrinsic = extrinsic_matrix()
    expected = extrinsic @ drive.offline.poses[:4] @ np.linalg.inv(extrinsic)
    stamped, transforms = transforms_of(topics.tf.messages, "lidar_odom")
    assert {t.header.frame_id for t in stamped} == {"robot"}
    np.testing.assert_allclose(np.linalg.inv(transforms), expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(poses_of(topics.odometry.messages), expected, rtol=0, atol=1e-9)
    assert topics.odometry.messages[0].header.frame_id == "lidar_odom"


def test_without_tf(topics, drive):
    with connected_node(topics, {**AT_ONCE, "publish_tf": False}):
        publish(topics, drive.sweeps[:2])
        wait_figure(topics, "sweeps registered", 2)
    assert not topics.tf.messages


def test_the_launch_file(topics, drive):
    launch = subprocess.Popen(["roslaunch", "rilo_ros", "odometry.launch", "points:=/points", "queue:=0"])
    try:
        connect(topics)
        publish(topics, drive.sweeps[:13])  # the first 12 are looked at before any pose is there
        np.testing.assert_allclose(poses_of(topics.odometry.messages), drive.offline.poses[:13], rtol=0, atol=1e-9)
    finally:
        stop(launch)
        delete_parameters("/rilo")
