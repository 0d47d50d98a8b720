"""Poses against those of `rilo run`, covariances, parameters, the launch file."""

import os
import subprocess

import numpy as np
import pytest
import rosbag
import rospy
from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud2

from driven_node import SWEEPS, connect, connected_node, poses_of, publish, run_offline, wait_figure
from ros_system import delete_parameters, first_of, play, stop


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


def test_the_launch_file(topics, drive):
    launch = subprocess.Popen(["roslaunch", "rilo_ros", "odometry.launch", "points:=/points", "queue:=0"])
    try:
        connect(topics)
        publish(topics, drive.sweeps[:13])  # the first 12 are looked at before any pose is there
        np.testing.assert_allclose(poses_of(topics.odometry.messages), drive.offline.poses[:13], rtol=0, atol=1e-9)
    finally:
        stop(launch)
        delete_parameters("/rilo")
