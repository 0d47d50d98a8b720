"""rosbags writes what Rilo reads."""

import json

import numpy as np
import packets
import pytest
from conftest import rilo, sweeps_in
from recordings import CONTAINERS, LAYOUTS, Message, cloud_message, livox_message, random_sweeps, write


def expect_sweeps(found, expected, tolerance_s):
    assert len(found) == len(expected)
    for sweep, truth in zip(found, expected):
        assert abs(sweep.stamp_ns - truth.stamp_ns) <= tolerance_s * 1e9
        assert np.array_equal(sweep.points, truth.points)
        assert np.array_equal(sweep.intensities, truth.intensities)
        assert np.array_equal(sweep.rings, truth.rings)
        assert np.allclose(sweep.times_s, truth.times_s, rtol=0, atol=tolerance_s)


@pytest.mark.parametrize("container", CONTAINERS)
@pytest.mark.parametrize("name", LAYOUTS)
def test_point_clouds(tmp_path, container, name):
    expected = random_sweeps(5)
    path = write(container, tmp_path, [cloud_message(name, sweep) for sweep in expected])
    # float64 has steps of 0.24 us at today's seconds, and of 0.26 us at today's nanoseconds
    expect_sweeps(sweeps_in(path, tmp_path), expected, 1e-8 if name in ("velodyne", "ouster") else 5e-7)
    info = json.loads(rilo("info", path, "--json"))
    assert info["topic"] == "/points" and info["frame_id"] == f"{name}_frame" and info["sweeps"] == 5


@pytest.mark.parametrize("container", CONTAINERS)
@pytest.mark.parametrize("package", ["livox_ros_driver", "livox_ros_driver2"])
def test_livox_custom_messages(tmp_path, container, package):
    expected = random_sweeps(4)
    path = write(container, tmp_path, [livox_message(package, sweep) for sweep in expected])
    expect_sweeps(sweeps_in(path, tmp_path), expected, 1e-8)


def expect_same(found, expected):
    assert len(found) == len(expected) > 0
    for sweep, other in zip(found, expected):
        assert sweep.stamp_ns == other.stamp_ns
        for name in ("points", "times_s", "rings", "intensities"):
            assert np.array_equal(getattr(sweep, name), getattr(other, name)), name


def velodyne_scan(part):
    def make(maker):
        messages = [
            maker.make(
                "velodyne_msgs/msg/VelodynePacket", stamp=maker.time(stamp), data=np.frombuffer(data, np.uint8)
            )
            for stamp, data in part
        ]
        return maker.make(
            "velodyne_msgs/msg/VelodyneScan", header=maker.header(part[0][0], "velodyne"), packets=messages
        )

    return Message("/velodyne_packets", "velodyne_msgs/msg/VelodyneScan", part[-1][0], make)


@pytest.mark.parametrize("container", CONTAINERS)
def test_velodyne_packets(tmp_path, container):
    all_packets = packets.vlp16(130)
    expected = sweeps_in(packets.capture(tmp_path / "v.pcap", 2368, all_packets), tmp_path)
    scans = [velodyne_scan(all_packets[i : i + 31]) for i in range(0, len(all_packets), 31)]
    expect_same(sweeps_in(write(container, tmp_path, scans), tmp_path), expected)


@pytest.mark.parametrize("container", CONTAINERS)
@pytest.mark.parametrize("package", ["ouster_ros", "ouster_sensor_msgs"])
def test_ouster_packets(tmp_path, container, package):
    all_packets = packets.ouster(140)
    (tmp_path / "o.json").write_text(packets.OUSTER_METADATA)
    expected = sweeps_in(packets.capture(tmp_path / "o.pcap", 7502, all_packets), tmp_path)
    (tmp_path / "o.json").unlink()

    def packet(topic, stamp, data):
        kind = f"{package}/msg/PacketMsg"
        return Message(topic, kind, stamp, lambda maker: maker.make(kind, buf=np.frombuffer(data, np.uint8)))

    text = lambda maker: maker.make("std_msgs/msg/String", data=packets.OUSTER_METADATA)  # noqa: E731
    messages = [Message("/ouster/metadata", "std_msgs/msg/String", packets.BEGIN_NS, text)]
    for stamp, data in all_packets:
        messages.append(packet("/ouster/lidar_packets", stamp, data))
        messages.append(packet("/ouster/imu_packets", stamp, bytes(48)))
    expect_same(sweeps_in(write(container, tmp_path, messages), tmp_path), expected)
