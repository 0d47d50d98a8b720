"""Opening data and running them whole: the keywords of both are the same."""

import os
import sys
import time
from numbers import Integral, Real

from ._rilo import _open, _run, _SourceOptions

_DEFAULTS = {
    "topic": "",
    "sensor_file": "",
    "bin_fields": "auto",
    "point_times": "auto",
    "point_time_unit": "infer",
    "point_time_reference": "infer",
    "time_field": "",
    "spin": "clockwise",
    "elevation_correction_deg": 0.0,
    "rate": None,
    "parts": 0,
    "skip_bad_sweeps": False,
}


def _refuse(name, value, expected):
    raise TypeError(f"{name}: got {value!r} of type {type(value).__name__}; expected {expected}")


def _checked(name, value):
    """An option as its default is: text, a number (or None, where that is the default) or a bool; sensor_file is a
    path, too."""
    default = _DEFAULTS[name]
    if value is None and default is None:
        return None
    if isinstance(default, str):
        value = os.fspath(value) if name == "sensor_file" and hasattr(value, "__fspath__") else value
        return value if isinstance(value, str) else _refuse(name, value, "text")
    if isinstance(default, bool):
        return bool(value) if value in (True, False) else _refuse(name, value, "True or False")
    if isinstance(default, int):
        return _whole_number(name, value)
    return value if isinstance(value, Real) else _refuse(name, value, "a number")


def _options(given):
    unknown = set(given) - set(_DEFAULTS)
    if unknown:
        raise TypeError(f"unknown option {sorted(unknown)[0]!r}; known: {', '.join(_DEFAULTS)}")
    return _SourceOptions(**{**_DEFAULTS, **{name: _checked(name, value) for name, value in given.items()}})


def _path(name, value):
    return value if isinstance(value, (str, bytes, os.PathLike)) else _refuse(name, value, "a path")


def _whole_number(name, value):
    if not isinstance(value, Integral):
        _refuse(name, value, "a whole number")
    if value < 0:
        raise ValueError(f"{name}: got {value}; expected a number from 0")
    return value


def open(path, **options):
    """Opens data of any format that `rilo run` reads and returns a ScanSource, which iterates over its sweeps.

    path: folder (KITTI, KITTI raw, MulRan, the drive simulator, .bin, .pcd, .ply), file, ROS 1 bag, rosbag2, MCAP or
    pcap.

    Options, named as those of the command:
    topic:                    topic of a recording that has several with scans.
    sensor_file:              what packets need: an Ouster's metadata (JSON; by default the one in or beside the
                              recording) or an HDL-64E's calibration (YAML of velodyne_pointcloud).
    bin_fields:               columns of a .bin record, float32 each: "x,y,z,intensity,time,ring"; _ is ignored.
    point_times:              auto: from the data when it has them; azimuth: from the angle of a spinning sensor whose
                              sweep is stamped at its forward direction (KITTI raw); order: from the order in which a
                              spinning sensor measured the points; none: compensated already. rilo.run() tries
                              whether points without times are raw (auto).
    point_time_unit:          infer, s, ms, us, ns or fraction.
    point_time_reference:     infer, stamp or epoch: what the time field counts from.
    time_field:               name of the field with the point times (PCD, PLY, PointCloud2).
    spin:                     clockwise or counter-clockwise, seen from above, for point_times="azimuth".
    elevation_correction_deg: added to every point's elevation angle; KITTI's HDL-64E needs 0.205.
    rate:                     sweeps per second of data without stamps. None: 10, and rilo.run() tries whether they are
                              fewer.
    parts:                    files or messages that hold a sweep in parts and are joined to one; 1: none are. 0: found
                              out where they come faster than 13 a second.
    skip_bad_sweeps:          skip sweeps that cannot be read instead of raising.

    Raises IoError when the data cannot be read, ValueError for an option that makes no sense.
    """
    return _open(_path("path", path), _options(options))


class _Progress:
    """A line on stderr that overwrites itself, five times per second at most."""

    def __init__(self):
        self.start = time.monotonic()
        self.shown = 0.0

    def __call__(self, done, total):
        now = time.monotonic()
        if now - self.shown < 0.2 and done != total:
            return
        self.shown = now
        of = "" if total is None else f"/{total}"
        rate = done / max(now - self.start, 1e-9)
        print(f"\r{done}{of} sweeps, {rate:.0f} per second ", end="", file=sys.stderr, flush=True)

    def restart(self, offset_deg):
        self.start = time.monotonic()
        print(f"\nsensor learnt (elevation offset {offset_deg:+.3f} deg): restarting", file=sys.stderr, flush=True)


def run(
    source,
    config=None,
    settings=None,
    *,
    start=0,
    count=0,
    calibration=None,
    one_pass=False,
    map_voxel_m=None,
    progress=False,
    on_sweep=None,
    on_restart=None,
    **options,
):
    """Runs the odometry over a recording or folder, as `rilo run` does and with the same poses; returns a RunResult.

    source:           path of the data, as for open(); further keywords are the options of open().
    config, settings: as for Odometry.
    start, count:     sweeps to skip, and to run at most (0: all).
    calibration:      angles of this sensor, learnt in another run: a path, or the text of RunResult.calibration.
    one_pass:         single pass, as in live operation. Otherwise the run restarts, once, where the first 200 sweeps
                      say something about the sensor (its elevation offset, the angles of its beams) or about the motion
                      at a late beginning.
    map_voxel_m:      also collects the map of the whole run, one point per voxel of this edge, m.
    progress:         shows a line on stderr.
    on_sweep:         called after every sweep with (index, SweepResult, Sweep).
    on_restart:       called before the second pass with (sweeps of the first, elevation offset in degrees or 0).

    Ctrl-C ends the run after the sweep in work and raises KeyboardInterrupt; an exception of a callable ends it, too.
    Raises IoError, ConfigError and ValueError as open() and Odometry do.
    """
    for name, called in {"on_sweep": on_sweep, "on_restart": on_restart}.items():
        if called is not None and not callable(called):
            _refuse(name, called, "a function or None")
    if map_voxel_m is not None and not isinstance(map_voxel_m, Real):
        _refuse("map_voxel_m", map_voxel_m, "a number or None")
    line = _Progress() if progress else None

    def restarted(after_sweeps, offset_deg):
        if line:
            line.restart(offset_deg)
        if on_restart:
            on_restart(after_sweeps, offset_deg)

    try:
        return _run(
            _path("source", source),
            _options(options),
            config=config,
            settings=settings,
            start=_whole_number("start", start),
            count=_whole_number("count", count),
            calibration=calibration,
            one_pass=one_pass,
            map_voxel_m=map_voxel_m,
            on_sweep=on_sweep,
            on_restart=restarted,
            on_progress=line,
        )
    finally:
        if line:
            print(file=sys.stderr)
