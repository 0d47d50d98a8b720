"""Odometry, sweep by sweep: shapes, values, life times, threads."""

import threading
import time

import numpy as np
import pytest
from conftest import SWEEPS

import rilo


def test_simulated_sweeps_are_float32_arrays(drive):
    points, times, stamp, pose = drive[3]
    assert points.dtype == np.float32 and points.shape[1] == 3 and len(points) > 5000
    assert times.dtype == np.float32 and times.shape == (len(points),)
    assert stamp == 300_000_000
    assert pose.shape == (4, 4)
    iterated = list(rilo.Simulator(sensor="vlp16", sweeps=2, start_s=4.0))
    assert len(iterated) == 2 and np.array_equal(iterated[1][0], drive[1][0]) and iterated[1][2] == drive[1][2]
    with pytest.raises(IndexError):
        rilo.Simulator(sweeps=2).sweep(2)
    with pytest.raises(IndexError):
        rilo.Simulator(sweeps=2).sweep(-1)
    with pytest.raises(ValueError, match="sensor: got 'hdl32'; expected hdl64"):
        rilo.Simulator(sensor="hdl32")


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


def test_drift_of_short_paths_and_of_none(drive, run):
    truth = np.stack([pose for *_, pose in drive])
    short = rilo.evaluate(truth, run[0].trajectory)  # 10 m
    assert 0 < short["t_rel_pct"] < 2 and short["r_rel_deg_per_100m"] > 0
    still = rilo.evaluate(truth[[0, 0, 0]], truth[[0, 0, 0]])
    assert still["path_m"] == 0 and still["t_rel_pct"] is None and still["r_rel_deg_per_100m"] is None
    with pytest.raises(ValueError, match="at least two poses, found 1"):
        rilo.evaluate(truth[:1], truth[:1])


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


def test_threads_that_share_an_odometry_wait_for_each_other(drive):
    odometry = rilo.Odometry()
    done = threading.Event()
    seen = []

    def write():
        for points, times, *_ in drive:
            odometry.register_frame(points, times)

    def read():
        while not done.is_set():
            seen.append((len(odometry.trajectory), len(odometry.local_map()), len(odometry.last_map_points())))

    writers, reader = [threading.Thread(target=write) for _ in range(3)], threading.Thread(target=read)
    for thread in (reader, *writers):
        thread.start()
    for thread in writers:
        thread.join()
    done.set()
    reader.join()
    assert len(odometry) == 3 * SWEEPS and np.all(np.diff(odometry.stamps_ns) > 0)
    assert seen == sorted(seen, key=lambda figures: figures[0])
