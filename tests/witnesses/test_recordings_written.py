"""mcap and rosbags read what Rilo writes."""

import numpy as np
import pytest
from conftest import SWEEPS, rilo
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from recordings import BEGIN_NS, cloud_message, random_sweeps, write
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore


def decoded(path):
    """(topic, log time in ns, message) of an MCAP, its chunks checked against their CRCs."""
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        return [(channel.topic, raw.log_time, message) for _, channel, raw, message in reader.iter_decoded_messages()]


def stamp_ns(header):
    nanoseconds = getattr(header.stamp, "nanosec", None)
    return header.stamp.sec * 10**9 + (header.stamp.nanosec if nanoseconds is not None else header.stamp.nsec)


def pose_numbers(pose):
    p, q = pose.position, pose.orientation
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w]


def tum(run):
    rows = [line.split() for line in (run.results / "trajectory.tum").read_text().splitlines() if line[0] != "#"]
    stamps = [int(row[0].replace(".", "")) for row in rows]
    return stamps, np.array([[float(word) for word in row[1:]] for row in rows])


def test_odometry_in_mcap(run):
    messages = decoded(run.results / "trajectory.mcap")
    odometry = [(log, message) for topic, log, message in messages if topic == "/odometry"]
    stamps, poses = tum(run)
    assert len(odometry) == len(stamps) == SWEEPS
    for (log, message), stamp, pose in zip(odometry, stamps, poses):
        assert log == stamp_ns(message.header) == stamp >= 0
        assert message.header.frame_id == "map" and message.child_frame_id == "top_lidar"
        numbers = np.array(pose_numbers(message.pose.pose))
        numbers[3:] *= np.sign(numbers[6])
        assert np.allclose(numbers, pose, rtol=0, atol=1e-9)
        for covariance in (message.pose.covariance, message.twist.covariance):
            matrix = np.array(covariance).reshape(6, 6)
            assert np.allclose(matrix, matrix.T, rtol=1e-9, atol=1e-15)
            assert np.linalg.eigvalsh(matrix).min() >= 0
    first, second = (np.array(message.twist.covariance).reshape(6, 6) for _, message in odometry[:2])
    assert np.array_equal(first, 1e6 * np.eye(6))
    assert second[0, 0] < 100


def test_transforms_in_mcap_are_the_poses(run):
    messages = decoded(run.results / "trajectory.mcap")
    odometry = [message for topic, _, message in messages if topic == "/odometry"]
    transforms = [message for topic, _, message in messages if topic == "/tf"]
    assert len(transforms) == len(odometry)
    for message, pose in zip(transforms, odometry):
        (transform,) = message.transforms
        assert transform.header.frame_id == "map" and transform.child_frame_id == "top_lidar"
        t, q = transform.transform.translation, transform.transform.rotation
        assert [t.x, t.y, t.z, q.x, q.y, q.z, q.w] == pose_numbers(pose.pose.pose)


def test_bag_has_what_the_mcap_has(run):
    bag = run.results / "trajectory.bag"
    if not bag.exists():
        pytest.skip("built without librosbag-storage")
    expected = [message for topic, _, message in decoded(run.results / "trajectory.mcap") if topic == "/odometry"]
    with AnyReader([bag]) as reader:
        assert {connection.topic for connection in reader.connections} == {"/odometry", "/tf"}
        odometry = [c for c in reader.connections if c.topic == "/odometry"]
        found = [reader.deserialize(raw, c.msgtype) for c, _, raw in reader.messages(odometry)]
        tf = [c for c in reader.connections if c.topic == "/tf"]
        assert sum(1 for _ in reader.messages(tf)) == SWEEPS
    assert len(found) == SWEEPS
    for message, other in zip(found, expected):
        assert message.header.frame_id == "map" and message.child_frame_id == "top_lidar"
        assert stamp_ns(message.header) == stamp_ns(other.header)
        assert pose_numbers(message.pose.pose) == pose_numbers(other.pose.pose)
        assert np.allclose(message.pose.covariance, other.pose.covariance, rtol=1e-12, atol=1e-20)
        assert np.allclose(message.twist.covariance, other.twist.covariance, rtol=1e-12, atol=1e-20)
        assert message.twist.twist.linear.x == other.twist.twist.linear.x


def test_definitions_are_those_of_ros(run):
    """The definition in the file and the one of ROS 2 give the same numbers from the same bytes."""
    types = get_typestore(Stores.ROS2_HUMBLE)
    with (run.results / "trajectory.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, _, message, ros_message in reader.iter_decoded_messages(topics=["/odometry"]):
            own = types.deserialize_cdr(message.data, schema.name)
            assert pose_numbers(own.pose.pose) == pose_numbers(ros_message.pose.pose)
            assert np.array_equal(own.twist.covariance, ros_message.twist.covariance)


def test_the_frame_of_the_data(tmp_path):
    path = write("mcap", tmp_path, [cloud_message("velodyne", sweep) for sweep in random_sweeps(3)])
    rilo("run", path, "--out", tmp_path / "out", "--quiet", "--no-report")
    messages = [message for topic, _, message in decoded(tmp_path / "out/trajectory.mcap") if topic == "/odometry"]
    assert [message.child_frame_id for message in messages] == ["velodyne_frame"] * 3
    assert [message.header.frame_id for message in messages] == ["odom"] * 3
    assert all(0 <= stamp_ns(message.header) - BEGIN_NS < 10**9 for message in messages)
