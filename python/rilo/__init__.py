"""LiDAR-only odometry: sweeps in, poses and a local map out.

Metres, radians, int64 nanoseconds. A pose T_odom_lidar maps the LiDAR's frame (x forward, y left, z up) to that of the
first sweep.
"""

from ._rilo import (
    ConfigError,
    IoError,
    Odometry,
    ScanSource,
    Simulator,
    Sweep,
    SweepResult,
    dump_config,
    evaluate,
    open,
)

__all__ = [
    "ConfigError",
    "IoError",
    "Odometry",
    "ScanSource",
    "Simulator",
    "Sweep",
    "SweepResult",
    "dump_config",
    "evaluate",
    "open",
]
