"""Rilo and KISS-ICP (pip install kiss-icp) on the same sweeps: time per sweep and error.

python beside_kiss_icp.py [DATA TRUTH] [--sweeps N] [--threads N] [--point-times HOW]

DATA is anything that rilo reads, TRUTH a file of its poses in KITTI's form (12 numbers a line, LiDAR frame, at the
middle of the sweeps). Without them: a simulated drive with an HDL-64. Both take the sweeps as they come, with default
settings and as many threads (1 unless said otherwise); reading and converting arrays is not timed, nor the first sweep.
"""

import argparse
import sys
import time
from importlib.metadata import version

import numpy as np

import rilo

try:
    from kiss_icp.config import load_config
    from kiss_icp.kiss_icp import KissICP
except ImportError:
    sys.exit("KISS-ICP is not installed: pip install kiss-icp")


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", nargs="?")
    parser.add_argument("truth", nargs="?")
    parser.add_argument("--sweeps", type=int, default=40)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--point-times", default="auto", help="as for rilo.open")
    arguments = parser.parse_args()
    if arguments.data and not arguments.truth:
        parser.error("TRUTH is missing")
    return arguments


def read_drive(arguments):
    """Sweeps as (points, times_s or None, stamp_ns), and their true poses (N, 4, 4)."""
    if arguments.data:
        sweeps = []
        for sweep in rilo.open(arguments.data, point_times=arguments.point_times):
            sweeps.append((sweep.points, sweep.times_s, sweep.stamp_ns))
            if len(sweeps) == arguments.sweeps:
                break
        return sweeps, rilo.read_poses(arguments.truth, "kitti")[: len(sweeps)]
    simulator = rilo.Simulator("hdl64", arguments.sweeps, start_s=10)
    simulated = [simulator.sweep(i) for i in range(len(simulator))]
    return [sweep[:3] for sweep in simulated], np.stack([sweep[3] for sweep in simulated])


def timed(register, frames):
    times_ms, poses = [], []
    for frame in frames:
        start = time.perf_counter()
        pose = register(*frame)
        times_ms.append(1e3 * (time.perf_counter() - start))
        poses.append(pose)
    return np.array(times_ms), np.stack(poses)


def run_rilo(sweeps, threads):
    odometry = rilo.Odometry(settings={"threads": threads})
    return timed(lambda *sweep: odometry.register(*sweep).pose, sweeps)


def run_kiss_icp(sweeps, threads):
    config = load_config(None)
    config.data.deskew = sweeps[0][1] is not None
    config.registration.max_num_threads = threads
    odometry = KissICP(config)

    def frame(points, times, _):
        fractions = np.zeros(0) if times is None else (times - times.min()) / np.ptp(times)
        return points.astype(np.float64), fractions.astype(np.float64)

    def register(points, fractions):
        odometry.register_frame(points, fractions)
        return odometry.last_pose

    return timed(register, [frame(*sweep) for sweep in sweeps])


def half_a_sweep_earlier(poses):
    """Poses at the end of the sweeps, at the middle of these: halfway from the one before."""
    earlier = poses.copy()
    earlier[1:, :3, 3] = (poses[1:, :3, 3] + poses[:-1, :3, 3]) / 2
    for i in range(1, len(poses)):
        u, _, v = np.linalg.svd(poses[i, :3, :3] + poses[i - 1, :3, :3])
        earlier[i, :3, :3] = u @ v
    return earlier


def report(name, times_ms, errors):
    drift = "" if errors["t_rel_pct"] is None else f"  t_rel {errors['t_rel_pct']:.3f} %"
    steady = times_ms[1:]
    print(
        f"{name:<16} {steady.mean():6.1f} ms a sweep (median {np.median(steady):.1f}, largest {steady.max():.1f})"
        f"  APE {errors['ape_rmse_m']:.4f} m  end {errors['end_error_m']:.3f} m{drift}"
    )


arguments = read_arguments()
sweeps, truth = read_drive(arguments)
points = np.mean([len(points) for points, *_ in sweeps])
print(f"{len(sweeps)} sweeps of {points:.0f} points, threads: {arguments.threads} each")
times_ms, poses = run_rilo(sweeps, arguments.threads)
report(f"rilo {rilo.__version__}", times_ms, rilo.evaluate(truth, poses))
times_ms, poses = run_kiss_icp(sweeps, arguments.threads)
# With motion compensation the pose may be that of the middle or of the end of a sweep: what suits it better counts.
candidates = [poses, half_a_sweep_earlier(poses)] if sweeps[0][1] is not None else [poses]
best = min((rilo.evaluate(truth, each) for each in candidates), key=lambda errors: errors["ape_rmse_m"])
report(f"kiss-icp {version('kiss-icp')}", times_ms, best)
