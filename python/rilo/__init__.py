"""LiDAR-only odometry: sweeps in, poses and a local map out.

    import rilo

    odometry = rilo.Odometry()
    for sweep in rilo.open("drive.bag"):
        result = odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
        print(result.status, result.position)

or the whole recording at once, as `rilo run` does it:

    run = rilo.run("drive.bag", progress=True)
    rilo.write_poses("poses.txt", run.trajectory, run.stamps_ns)

Metres, radians, int64 nanoseconds. A pose T_odom_lidar maps the LiDAR's frame (x forward, y left, z up) to that of the
first sweep. The command `rilo` comes with the package, also as `python -m rilo`.
"""

from ._rilo import (
    ConfigError,
    IoError,
    Odometry,
    RunResult,
    ScanSource,
    Simulator,
    Sweep,
    SweepResult,
    __version__,
    dump_config,
    evaluate,
    read_poses,
    write_map,
    write_poses,
)
from ._sources import open, run

__all__ = [
    "ConfigError",
    "IoError",
    "Odometry",
    "RunResult",
    "ScanSource",
    "Simulator",
    "Sweep",
    "SweepResult",
    "__version__",
    "dump_config",
    "evaluate",
    "open",
    "read_poses",
    "run",
    "write_map",
    "write_poses",
]
