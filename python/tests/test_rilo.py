"""The Python package against the C++ it wraps: shapes, values, errors, life times, threads."""

import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import rilo

SWEEPS = 12


@pytest.fixture(scope="module")
def drive():
    simulator = rilo.Simulator(sensor="vlp16", sweeps=SWEEPS, start_s=4.0)
    assert len(simulator) == SWEEPS
    return [simulator.sweep(i) for i in range(SWEEPS)]


@pytest.fixture(scope="module")
def run(drive):
    odometry = rilo.Odometry()
    return odometry, [odometry.register(points, times, stamp) for points, times, stamp, _ in drive]


def test_simulated_sweeps_are_float32_arrays(drive):
    points, times, stamp, pose = drive[3]
    assert points.dtype == np.float32 and points.shape[1] == 3 and len(points) > 5000
    assert times.dtype == np.float32 and times.shape == (len(points),)
    assert stamp == 300_000_000
    assert pose.shape == (4, 4)
    with pytest.raises(IndexError):
        rilo.Simulator(sweeps=2).sweep(2)


def test_the_drive_is_tracked(drive, run):
    odometry, results = run
    truth = np.stack([pose for *_, pose in drive])
    errors = rilo.evaluate(truth, odometry.trajectory)
    assert errors["ape_rmse_m"] < 0.05
    assert errors["poses"] == SWEEPS
    assert errors["path_m"] > 5
    assert np.array_equal(results[-1].pose, odometry.trajectory[-1])
    assert results[0].status == "initialising" and results[-1].status == "ok"
    assert results[-1].total_ms > 0


def test_results_have_their_shapes(run):
    odometry, results = run
    result = results[-1]
    assert result.twist.shape == (6,) and result.covariance.shape == (6, 6)
    assert np.all(np.linalg.eigvalsh(result.covariance) > 0)
    assert len(result.relative_eigenvalues) == 6
    assert odometry.trajectory.shape == (SWEEPS, 4, 4)
    assert odometry.stamps_ns.dtype == np.int64 and np.all(np.diff(odometry.stamps_ns) > 0)
    assert odometry.local_map().dtype == np.float32
    assert "ok" in repr(result)


def test_other_layouts_give_the_same_bits(drive, run):
    odometry = rilo.Odometry()
    for points, times, stamp, _ in drive[:4]:
        wide = np.zeros((len(points), 4))
        wide[:, :3] = points
        odometry.register(wide[:, :3], times.astype(np.float64), stamp)
    assert np.array_equal(odometry.trajectory, run[0].trajectory[:4])


def test_arrays_outlive_what_they_came_from(drive):
    odometry = rilo.Odometry()
    points, times, stamp, _ = drive[0]
    odometry.register(points, times, stamp)
    local_map = odometry.local_map()
    total = local_map.sum()
    odometry.reset()
    del odometry
    assert local_map.sum() == total and len(local_map) > 1000


def test_threads_go_on_while_registering(drive):
    ticks = 0
    done = threading.Event()

    def count():
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.0005)

    other = threading.Thread(target=count)
    other.start()
    odometry = rilo.Odometry()
    for points, times, stamp, _ in drive:
        odometry.register(points, times, stamp)
    done.set()
    other.join()
    assert ticks > SWEEPS


def test_configuration():
    assert "voxel_m: 0.5" in rilo.dump_config(settings=["map.voxel_m=0.5"])
    assert "max_iterations: 7" in rilo.dump_config("icp: {max_iterations: 7}")
    with pytest.raises(rilo.ConfigError, match="icp.max_iteration.*max_iterations"):
        rilo.Odometry("icp: {max_iteration: 7}")
    with pytest.raises(ValueError, match="voxel_m"):
        rilo.Odometry(settings=["map.voxel_m=-1"])


def test_bad_arrays_are_refused(drive):
    points, times, _, _ = drive[0]
    odometry = rilo.Odometry()
    with pytest.raises(ValueError, match=r"\(N, 3\)"):
        odometry.register(points[:, :2])
    with pytest.raises(ValueError, match=f"times_s: 3 values for {len(points)} points"):
        odometry.register(points, times[:3])
    with pytest.raises(ValueError, match="rings"):
        odometry.register(points, times, 0, np.zeros(2, np.uint16))
    with pytest.raises(ValueError, match=r"\(N, 4, 4\)"):
        rilo.evaluate(np.eye(4), np.eye(4))
    assert odometry.register(np.zeros((0, 3), np.float32)).status == "empty"
    assert odometry.register(np.full((100, 3), np.nan, np.float32), stamp_ns=1).status == "empty"


def test_files_are_read(tmp_path, drive):
    for i, (points, *_) in enumerate(drive[:3]):
        np.hstack([points, np.ones((len(points), 1), np.float32)]).tofile(tmp_path / f"{i:06d}.bin")
    source = rilo.open(str(tmp_path))
    assert len(source) == 3 and source.format == "bin"
    sweeps = list(source)
    for sweep, (points, *_) in zip(sweeps, drive):
        assert np.array_equal(sweep.points, points) and len(sweep) == len(points)
        assert sweep.times_s is None and np.all(sweep.intensities == 1)
    with pytest.raises(rilo.IoError, match="nowhere"):
        rilo.open(str(tmp_path / "nowhere"))
    with pytest.raises(ValueError, match="point_times"):
        rilo.open(str(tmp_path), point_times="sometimes")


def test_the_example_runs(tmp_path, drive):
    for i, (points, *_) in enumerate(drive[:2]):
        np.hstack([points, np.ones((len(points), 1), np.float32)]).tofile(tmp_path / f"{i:06d}.bin")
    example = Path(__file__).parent.parent / "examples" / "minimal.py"
    done = subprocess.run([sys.executable, example, tmp_path], capture_output=True, text=True, check=True)
    assert "points in the local map" in done.stdout
