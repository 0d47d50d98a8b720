"""Recordings by rosbags, in the layouts that drivers give their points."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

import numpy as np
from rosbags.rosbag1 import Writer as Bag
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

BEGIN_NS = 1_700_000_000_250_000_000
PERIOD_NS = 100_000_000
POINTS = 500

DEFINITIONS = {
    "livox_ros_driver/msg/CustomPoint": "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\n"
    "uint8 tag\nuint8 line\n",
    "livox_ros_driver/msg/CustomMsg": "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\n"
    "uint8[3] rsvd\nlivox_ros_driver/CustomPoint[] points\n",
    "velodyne_msgs/msg/VelodynePacket": "{time} stamp\nuint8[1206] data\n",
    "velodyne_msgs/msg/VelodyneScan": "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n",
    "ouster_ros/msg/PacketMsg": "uint8[] buf\n",
}
for name in ("CustomPoint", "CustomMsg"):
    text = DEFINITIONS[f"livox_ros_driver/msg/{name}"]
    DEFINITIONS[f"livox_ros_driver2/msg/{name}"] = text.replace("livox_ros_driver/", "livox_ros_driver2/")
DEFINITIONS["ouster_sensor_msgs/msg/PacketMsg"] = DEFINITIONS["ouster_ros/msg/PacketMsg"]


def store(ros1: bool):
    types = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    time = "time" if ros1 else "builtin_interfaces/Time"
    for name, definition in DEFINITIONS.items():
        types.register(get_types_from_msg(definition.replace("{time}", time), name))
    return types


STORES = {True: store(True), False: store(False)}


@dataclass
class Maker:
    """Makes messages of one ROS."""

    ros1: bool

    def make(self, kind: str, **fields) -> Any:
        return STORES[self.ros1].types[kind](**fields)

    def time(self, stamp_ns: int) -> Any:
        return self.make("builtin_interfaces/msg/Time", sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)

    def header(self, stamp_ns: int, frame_id: str) -> Any:
        number = {"seq": 7} if self.ros1 else {}
        return self.make("std_msgs/msg/Header", stamp=self.time(stamp_ns), frame_id=frame_id, **number)


@dataclass
class Message:
    topic: str
    type: str
    received_ns: int
    make: Callable[[Maker], Any]


def write(container: str, folder: Path, messages: list[Message]) -> Path:
    """container: one of CONTAINERS."""
    ros1 = container.startswith("bag")
    types = STORES[ros1]
    path = folder / ("r.bag" if ros1 else f"r_{container}")
    if ros1:
        writer = Bag(path)
        if "-" in container:
            writer.set_compression(Bag.CompressionFormat[container.split("-")[1].upper()])
    else:
        writer = Rosbag2(path, version=8, storage_plugin=StoragePlugin[container.upper()])
    with writer:
        connections = {}
        for message in messages:
            if message.topic not in connections:
                connections[message.topic] = writer.add_connection(message.topic, message.type, typestore=types)
            made = message.make(Maker(ros1))
            raw = types.serialize_ros1(made, message.type) if ros1 else types.serialize_cdr(made, message.type)
            writer.write(connections[message.topic], message.received_ns, bytes(raw))
    return path


# Not LZ4 in ROS 1 bags: rosbags links the blocks of its frames, which ROS itself does not unpack.
CONTAINERS = ["bag", "bag-bz2", "sqlite3", "mcap"]

KINDS = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}


def layout(size: int, **fields: tuple[str, int]) -> np.dtype:
    """name=(kind, offset)"""
    return np.dtype(
        {
            "names": list(fields),
            "formats": ["<" + kind for kind, _ in fields.values()],
            "offsets": [offset for _, offset in fields.values()],
            "itemsize": size,
        }
    )


XYZ = {"x": ("f4", 0), "y": ("f4", 4), "z": ("f4", 8)}
# Of velodyne_pointcloud, ouster_ros, hesai_ros_driver, livox_ros_driver2; the first and the last without alignment.
LAYOUTS = {
    "velodyne": layout(22, **XYZ, intensity=("f4", 12), ring=("u2", 16), time=("f4", 18)),
    "ouster": layout(
        48,
        **XYZ,
        intensity=("f4", 16),
        t=("u4", 20),
        reflectivity=("u2", 24),
        ring=("u1", 26),
        ambient=("u2", 28),
        range=("u4", 32),
    ),
    "hesai": layout(48, **XYZ, intensity=("f4", 16), timestamp=("f8", 24), ring=("u2", 32)),
    "livox": layout(26, **XYZ, intensity=("f4", 12), tag=("u1", 16), line=("u1", 17), timestamp=("f8", 18)),
}


@dataclass
class Expected:
    """A sweep; times in s since the stamp."""

    stamp_ns: int
    points: np.ndarray
    intensities: np.ndarray
    rings: np.ndarray
    times_s: np.ndarray


def random_sweeps(count: int) -> list[Expected]:
    random = np.random.default_rng(3)
    sweeps = []
    for i in range(count):
        sweeps.append(
            Expected(
                BEGIN_NS + i * PERIOD_NS,
                random.uniform(-50, 50, (POINTS, 3)).astype(np.float32),
                random.integers(0, 256, POINTS).astype(np.float32),
                random.integers(0, 32, POINTS).astype(np.uint16),
                np.linspace(0, 0.0995, POINTS),
            )
        )
    return sweeps


def points_in_layout(name: str, sweep: Expected) -> np.ndarray:
    data = np.zeros(POINTS, LAYOUTS[name])
    data["x"], data["y"], data["z"] = sweep.points.T
    data["intensity"] = sweep.intensities
    data["line" if name == "livox" else "ring"] = sweep.rings
    if name == "velodyne":
        data["time"] = sweep.times_s
    elif name == "ouster":
        data["t"] = np.rint(sweep.times_s * 1e9)
    elif name == "hesai":
        data["timestamp"] = sweep.stamp_ns * 1e-9 + sweep.times_s
    else:
        data["timestamp"] = sweep.stamp_ns + sweep.times_s * 1e9
    return data


def cloud_message(name: str, sweep: Expected) -> Message:
    data = points_in_layout(name, sweep)

    def make(maker: Maker) -> Any:
        fields = [
            maker.make(
                "sensor_msgs/msg/PointField", name=field, offset=offset, datatype=KINDS[scalar.str[1:]], count=1
            )
            for field, (scalar, offset) in data.dtype.fields.items()
        ]
        return maker.make(
            "sensor_msgs/msg/PointCloud2",
            header=maker.header(sweep.stamp_ns, f"{name}_frame"),
            height=1,
            width=POINTS,
            fields=fields,
            is_bigendian=False,
            point_step=data.itemsize,
            row_step=data.itemsize * POINTS,
            data=np.frombuffer(data.tobytes(), np.uint8),
            is_dense=True,
        )

    return Message("/points", "sensor_msgs/msg/PointCloud2", sweep.stamp_ns + PERIOD_NS, make)


def livox_message(package: str, sweep: Expected) -> Message:
    def make(maker: Maker) -> Any:
        points = [
            maker.make(
                f"{package}/msg/CustomPoint",
                offset_time=int(round(time * 1e9)),
                x=point[0],
                y=point[1],
                z=point[2],
                reflectivity=int(intensity),
                tag=16,
                line=int(ring),
            )
            for point, time, intensity, ring in zip(sweep.points, sweep.times_s, sweep.intensities, sweep.rings)
        ]
        return maker.make(
            f"{package}/msg/CustomMsg",
            header=maker.header(sweep.stamp_ns, "livox_frame"),
            timebase=sweep.stamp_ns,
            point_num=POINTS,
            lidar_id=1,
            rsvd=np.zeros(3, np.uint8),
            points=points,
        )

    return Message("/livox/lidar", f"{package}/msg/CustomMsg", sweep.stamp_ns + PERIOD_NS, make)
