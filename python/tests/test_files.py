"""Poses, maps and sweeps in files."""

import os
import threading

import numpy as np
import pytest
from conftest import SWEEPS

import rilo


def test_poses_and_maps_go_to_files_and_back(tmp_path, run):
    odometry, _ = run
    poses, stamps = odometry.trajectory, odometry.stamps_ns
    rilo.write_poses(tmp_path / "a.txt", poses, stamps)
    stamps_read, poses_read = rilo.read_poses(tmp_path / "a.txt")
    assert np.array_equal(stamps_read, stamps) and np.abs(poses_read - poses).max() < 1e-8
    rilo.write_poses(tmp_path / "k.txt", poses[:, :3], format="kitti")
    assert np.abs(rilo.read_poses(tmp_path / "k.txt", "kitti") - poses).max() < 1e-9
    rilo.write_poses(tmp_path / "e.csv", poses, stamps, "euroc")
    assert len((tmp_path / "e.csv").read_text().splitlines()) == SWEEPS + 1
    stamps_read, poses_read = rilo.read_poses(tmp_path / "e.csv", "euroc")
    assert np.array_equal(stamps_read, stamps) and np.abs(poses_read - poses).max() < 1e-8
    with pytest.raises(ValueError, match="stamps_ns: needed for format tum"):
        rilo.write_poses(tmp_path / "b.txt", poses)
    with pytest.raises(ValueError, match=r"stamps_ns: got shape \(3,\), int64; expected shape \(12,\)"):
        rilo.write_poses(tmp_path / "b.txt", poses, stamps[:3])
    with pytest.raises(ValueError, match="format: got 'csv'"):
        rilo.write_poses(tmp_path / "b.txt", poses, stamps, "csv")
    rilo.write_map(tmp_path / "map.pcd", odometry.local_map())
    assert np.array_equal(next(rilo.open(tmp_path / "map.pcd")).points, odometry.local_map())
    with pytest.raises(rilo.IoError, match="map.xyz"):
        rilo.write_map(tmp_path / "map.xyz", odometry.local_map())


def test_poses_that_are_none_are_not_written(tmp_path, run):
    poses, stamps = run[0].trajectory, run[0].stamps_ns
    scaled, mirrored, empty, broken = poses.copy(), poses.copy(), poses.copy(), poses.copy()
    scaled[2, :3, :3] *= 2
    mirrored[2, :3, 0] *= -1
    empty[2] = 0
    broken[2, 0, 3] = np.nan
    file = tmp_path / "poses.txt"
    for bad, told in ((scaled, "rigid transform"), (mirrored, "rigid transform"), (empty, "rigid"), (broken, "finite")):
        for form in "tum", "euroc", "kitti":
            with pytest.raises(ValueError, match=f"poses: pose 2 is not .*{told}"):
                rilo.write_poses(file, bad, stamps, form)
        with pytest.raises(ValueError, match=f"estimate: pose 2 is not .*{told}"):
            rilo.evaluate(poses, bad)
    with pytest.raises(ValueError, match=r"stamps_ns: got 92233720369\d+ at index 0"):
        rilo.write_poses(file, poses, stamps.astype(np.uint64) + np.uint64(2**63))
    assert not file.exists()
    rilo.write_poses(file, poses.astype(np.float32), stamps)


def test_files_are_read(tmp_path, drive):
    for i, (points, *_) in enumerate(drive[:3]):
        np.hstack([points, np.ones((len(points), 1), np.float32)]).tofile(tmp_path / f"{i:06d}.bin")
    source = rilo.open(str(tmp_path))
    assert len(source) == 3 and source.format == "bin"
    sweeps = list(source)
    for sweep, (points, *_) in zip(sweeps, drive):
        assert np.array_equal(sweep.points, points) and len(sweep) == len(points)
        assert sweep.times_s is None and np.all(sweep.intensities == 1)
    with pytest.raises(rilo.IoError, match="nowhere \ufffd"):
        rilo.open(os.fsencode(tmp_path) + b"/nowhere \xe9")
    with pytest.raises(rilo.IoError, match="nowhere"):
        rilo.open(str(tmp_path / "nowhere"))
    assert rilo.open(tmp_path, rate=4).period_s == 0.25
    assert rilo.open(tmp_path, rate=None).period_s == 0.1
    assert next(rilo.open(tmp_path, point_times="azimuth")).times_s is not None
    assert np.all(next(rilo.open(tmp_path, bin_fields="x,y,z,time", point_time_unit="s")).times_s == 1)
    one, other = (next(rilo.open(tmp_path, point_times="azimuth", spin=s)) for s in ("clockwise", "counter-clockwise"))
    assert np.array_equal(one.times_s, -other.times_s)
    corrected = next(rilo.open(tmp_path, elevation_correction_deg=0.2))
    assert not np.array_equal(corrected.points, sweeps[0].points)
    for option in "point_times", "point_time_unit", "point_time_reference", "spin":
        with pytest.raises(ValueError, match=f"{option}: got 'sometimes'; expected "):
            rilo.open(str(tmp_path), **{option: "sometimes"})


def test_a_bad_sweep_raises_or_is_skipped(tmp_path, drive):
    for i, (points, *_) in enumerate(drive[:3]):
        points.tofile(tmp_path / f"{i:06d}.bin")
    (tmp_path / "000001.bin").write_bytes(b"too short")
    with pytest.raises(rilo.IoError, match="000001.bin"):
        list(rilo.open(tmp_path, bin_fields="x,y,z"))
    assert len(list(rilo.open(tmp_path, bin_fields="x,y,z", skip_bad_sweeps=True))) == 2


def test_a_source_is_closed_by_with_and_by_close(recording):
    with rilo.open(recording) as source:
        sweep = next(source)
        assert repr(source).startswith("<rilo.ScanSource /")
    assert len(sweep.points) == len(sweep) > 0  # what was read stays
    assert repr(source) == "<rilo.ScanSource, closed>"
    source.close()
    for asked in (lambda: next(source), lambda: len(source), lambda: source.kind, lambda: source.skip(1)):
        with pytest.raises(ValueError, match="the ScanSource is closed"):
            asked()


def test_threads_share_a_source(recording):
    source = rilo.open(recording)
    taken = []
    readers = [threading.Thread(target=lambda: taken.extend(sweep.stamp_ns for sweep in source)) for _ in range(3)]
    for reader in readers:
        reader.start()
    for reader in readers:
        reader.join()
    assert sorted(taken) == [sweep.stamp_ns for sweep in rilo.open(recording)]
