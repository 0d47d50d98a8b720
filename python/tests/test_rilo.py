"""The Python package against the C++ it wraps: shapes, values, errors, life times, threads."""

import ast
import inspect
import os
import pydoc
import re
import signal
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


def test_settings_are_dicts_or_texts():
    nested = rilo.dump_config(settings={"map": {"voxel_m": 0.25}, "icp": {"max_iterations": np.int64(9)}})
    assert "voxel_m: 0.25" in nested and "max_iterations: 9" in nested
    assert nested == rilo.dump_config(settings={"map.voxel_m": np.float32(0.25), "icp.max_iterations": 9})
    assert nested == rilo.dump_config({"map": {"voxel_m": 0.25}}, ["icp.max_iterations=9"])
    assert nested == rilo.Odometry(settings={"map.voxel_m": 0.25, "icp.max_iterations": 9}).config()
    for argument in "settings", "config":
        with pytest.raises(rilo.ConfigError, match=f"^{argument} map.voxel=0.25: unknown key .* map.voxel_m"):
            rilo.Odometry(**{argument: {"map": {"voxel": 0.25}}})
    with pytest.raises(rilo.ConfigError, match=r'^settings map: there is no "=".*Example: icp.max_iterations=20'):
        rilo.Odometry(settings=["map"])
    with pytest.raises(TypeError, match=r"map.voxel_m: got \[1\] of type list; expected a number"):
        rilo.Odometry(settings={"map.voxel_m": [1]})
    with pytest.raises(TypeError, match="settings: got 'map.voxel_m=1' of type str; expected a dict or a list"):
        rilo.Odometry(settings="map.voxel_m=1")
    with pytest.raises(TypeError, match="config: got 3"):
        rilo.Odometry(3)


def test_a_configuration_file_is_a_path(tmp_path):
    file = tmp_path / "my.yaml"
    file.write_text("map: {voxel_m: 0.75}\n")
    assert "voxel_m: 0.75" in rilo.dump_config(file) and "voxel_m: 0.75" in rilo.dump_config(str(file))


def test_bools_are_settings():
    on = rilo.dump_config(settings={"coarse.enabled": True})
    off = rilo.dump_config(settings={"coarse.enabled": False})
    assert on != off and off == rilo.dump_config(settings=["coarse.enabled=false"])


REFUSED_POINTS = [
    (np.zeros((5, 2), np.float32), r"points: got shape \(5, 2\), float32; expected shape \(N, 3\) or \(N, 4\)"),
    (np.zeros((3, 100)), r"got shape \(3, 100\), float64; .*Transpose it: points.T"),
    (np.zeros((5, 6), np.float32), r"got shape \(5, 6\).*points\[:, :3\]"),
    (np.zeros((5, 3), np.int16), r"got shape \(5, 3\), int16; .*astype"),
    (np.zeros((5, 3), ">f4"), "got shape .*>f4"),
    (np.zeros(5, [("x", "f4"), ("y", "f4"), ("z", "f4")]), "Of fields: np.stack"),
    (np.zeros(12, np.float32), r"got shape \(12,\)"),
    ("points", "points: got"),
    (None, "points: got"),
]


@pytest.mark.parametrize("points, message", REFUSED_POINTS)
def test_other_points_are_refused_with_what_came(points, message):
    odometry = rilo.Odometry()
    for call in odometry.register, odometry.register_frame:
        with pytest.raises(ValueError, match=message):
            call(points)
    assert len(odometry) == 0


def test_bad_columns_are_refused(drive):
    points, times, _, _ = drive[0]
    odometry = rilo.Odometry()
    with pytest.raises(ValueError, match=f"times_s: 3 values for {len(points)} points"):
        odometry.register(points, times[:3])
    with pytest.raises(ValueError, match="times_s: got .*int64; expected float32 or float64, seconds"):
        odometry.register(points, np.zeros(len(points), np.int64))
    with pytest.raises(ValueError, match=r"times_s: got shape \(\d+, 1\)"):
        odometry.register(points, times[:, None])
    with pytest.raises(ValueError, match="rings: 2 values"):
        odometry.register(points, times, 0, np.zeros(2, np.uint16))
    with pytest.raises(ValueError, match="rings: got -1 at index 0"):
        odometry.register(points, times, 0, np.full(len(points), -1))
    with pytest.raises(ValueError, match="rings: got .*float64"):
        odometry.register(points, times, 0, np.zeros(len(points)))
    with pytest.raises(ValueError, match=r"truth: got shape \(4, 4\), float64; expected poses of shape \(N, 4, 4\)"):
        rilo.evaluate(np.eye(4), np.eye(4))
    assert len(odometry) == 0
    assert odometry.register(np.zeros((0, 3), np.float32)).status == "empty"
    assert odometry.register(np.full((100, 3), np.nan, np.float32), stamp_ns=1).status == "empty"


def test_layouts_types_and_columns_give_the_same_bits(drive, run):
    expected = run[0].trajectory[:3]
    wide = [np.hstack([points, np.full((len(points), 1), 7, np.float32)]) for points, *_ in drive[:3]]
    layouts = {
        "N x 4": lambda i: wide[i],
        "float64": lambda i: drive[i][0].astype(np.float64),
        "N x 4 float64": lambda i: wide[i].astype(np.float64),
        "columns together": lambda i: np.asfortranarray(drive[i][0]),
        "every second row": lambda i: np.repeat(drive[i][0], 2, axis=0)[::2],
        "a slice of columns": lambda i: wide[i][:, :3],
        "lists": lambda i: drive[i][0].tolist(),
    }
    for name, layout in layouts.items():
        odometry = rilo.Odometry()
        for i in range(3):
            odometry.register(layout(i), drive[i][1], drive[i][2])
        assert np.array_equal(odometry.trajectory, expected), name


def test_rings_of_any_integer_type_are_the_same(drive):
    points, times, stamp, _ = drive[0]
    rings = np.arange(len(points)) % 16
    maps = []
    for dtype in np.uint16, np.int64, np.uint8:
        odometry = rilo.Odometry()
        odometry.register(points, times, stamp, rings.astype(dtype))
        maps.append(odometry.local_map())
    assert np.array_equal(maps[0], maps[1]) and np.array_equal(maps[0], maps[2])


def test_register_frame_takes_the_drivers_timestamps(drive, run):
    expected = run[0].trajectory[:4]
    earliest = [times[np.linalg.norm(points, axis=1) > 0].min() for points, times, *_ in drive]
    assert min(earliest) >= 0
    clock = 1_700_000_000

    def poses(stamps_of_points, **options):
        odometry = rilo.Odometry()
        for points, times, stamp, _ in drive[:4]:
            odometry.register_frame(points, stamps_of_points(times, stamp), **options)
        return odometry

    relative = poses(lambda times, stamp: times)  # 0.1 s apart, as the drive is
    assert np.array_equal(relative.trajectory, expected)
    assert np.array_equal(relative.stamps_ns, run[0].stamps_ns[:4])
    for name, absolute in {
        "float64 s": lambda times, stamp: clock + stamp * 1e-9 + times.astype(np.float64),
        "int64 ns": lambda times, stamp: clock * 10**9 + stamp + np.round(times.astype(np.float64) * 1e9).astype(np.int64),
        "uint64 us": lambda times, stamp: (clock * 10**6 + stamp // 1000 + times.astype(np.float64) * 1e6).astype(np.uint64),
    }.items():
        odometry = poses(absolute)
        assert np.abs(odometry.trajectory - expected).max() < 1e-3, name
        assert np.abs(odometry.stamps_ns - run[0].stamps_ns[:4] - clock * 10**9).max() < 2_000_000, name
    fractions = poses(lambda times, stamp: times / np.float32(0.1), point_time_unit="fraction")
    assert np.abs(fractions.trajectory - expected).max() < 1e-4


def test_register_frame_without_timestamps_is_register(drive):
    one, other = rilo.Odometry(), rilo.Odometry()
    for i, (points, *_) in enumerate(drive[:3]):
        one.register_frame(points)
        other.register(points, None, i * 100_000_000)
    assert np.array_equal(one.trajectory, other.trajectory) and np.array_equal(one.stamps_ns, other.stamps_ns)
    one.reset()
    assert one.register_frame(drive[0][0]).stamp_ns == 0


def test_register_frame_refuses_what_cannot_be_told(drive):
    points, times, _, _ = drive[0]
    odometry = rilo.Odometry()
    with pytest.raises(rilo.IoError, match="either seconds or fractions.*point_time_unit"):
        odometry.register_frame(points, times / np.float32(0.1))
    with pytest.raises(ValueError, match=r"timestamps: got shape \(3,\), float32; expected shape \(\d+,\)"):
        odometry.register_frame(points, times[:3])
    with pytest.raises(ValueError, match="point_time_unit: got 'minutes'; expected infer, s, ms"):
        odometry.register_frame(points, times, point_time_unit="minutes")
    assert len(odometry) == 0


def test_points_are_used_in_place_and_kept(drive):
    points = drive[0][0].copy()
    points.flags.writeable = False
    odometry = rilo.Odometry()
    odometry.register(points)
    odometry.register_frame(points, drive[0][1])
    assert np.array_equal(points, drive[0][0])


def test_what_a_notebook_shows(drive, run, tmp_path):
    odometry, results = run
    assert re.fullmatch(r"<rilo.SweepResult ok at 1\.1\d* s, position \(.*\) m, \d+ correspondences>", repr(results[-1]))
    assert f"after {SWEEPS} sweeps" in repr(odometry)
    (tmp_path / "a&b").mkdir()
    drive[0][0].tofile(tmp_path / "a&b" / "000000.bin")
    source = rilo.open(tmp_path / "a&b", bin_fields="x,y,z", rate=20)
    assert "folder, bin, 1 sweeps" in repr(source)
    assert "a&amp;b" in source._repr_html_() and "0.05 s, assumed" in source._repr_html_()
    assert "<table>" in results[-1]._repr_html_() and "ok" in results[-1]._repr_html_()
    assert "path" in odometry._repr_html_()
    assert f"of {len(drive[0][0])} points at 0.000 s" in repr(next(source))
    assert f"of {SWEEPS} sweeps" in repr(rilo.Simulator(sweeps=SWEEPS))


def test_help_says_everything():
    for name in rilo.__all__:
        if name != "__version__":
            assert len(getattr(rilo, name).__doc__) > 20, name
    for cls in rilo.Odometry, rilo.RunResult, rilo.SweepResult, rilo.Sweep, rilo.ScanSource, rilo.Simulator:
        for name, member in vars(cls).items():
            if not name.startswith("_"):
                assert len(member.__doc__ or "") > 15, f"{cls.__name__}.{name}"
    assert "point_time_unit" in pydoc.render_doc(rilo.open) and "Raises IoError" in pydoc.render_doc(rilo.open)


def test_the_stub_names_what_there_is():
    stub = (Path(rilo.__file__).parent / "__init__.pyi").read_text()
    tree = ast.parse(stub)
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    assert set(classes) | functions | {"__version__"} == set(rilo.__all__)
    for name, node in classes.items():
        public = {n for n in vars(getattr(rilo, name)) if not n.startswith("_")}
        assert {n.name for n in node.body if isinstance(n, ast.FunctionDef) and n.name[0] != "_"} == public, name
    assert (Path(rilo.__file__).parent / "py.typed").exists()


def test_the_stub_has_the_arguments_there_are():
    tree = ast.parse((Path(rilo.__file__).parent / "__init__.pyi").read_text())
    options = set(rilo._sources._DEFAULTS)
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef) or node.decorator_list:
            continue
        wanted = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
        function = getattr(rilo, node.name)
        if inspect.isbuiltin(function):
            assert re.findall(r"[(,] ?(\w+):", function.__doc__.splitlines()[0]) == wanted, node.name
        else:
            named = [p.name for p in inspect.signature(function).parameters.values() if p.kind != p.VAR_KEYWORD]
            assert set(named) | options == set(wanted), node.name


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
    assert rilo.open(tmp_path, rate=4).period_s == 0.25
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


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "rilo", *arguments], capture_output=True, text=True, check=False)


def test_the_command_comes_along():
    assert command("--version").stdout == f"rilo {rilo.__version__}\n"
    wrong = command("run")
    assert wrong.returncode == 2 and "rilo: error" in wrong.stderr


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recording") / "drive"
    made = command("simulate", "--out", folder, "--sensor", "vlp16", "--start", "4", "--sweeps", str(SWEEPS), "--quiet")
    assert made.returncode == 0, made.stderr
    return folder


def test_the_command_gives_the_same_bits(tmp_path, recording):
    out = tmp_path / "out"
    ran = command("run", recording, "--out", out, "--one-pass", "--quiet")
    assert ran.returncode == 0, ran.stderr
    odometry = rilo.Odometry()
    for sweep in rilo.open(recording):
        odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
    rilo.write_poses(tmp_path / "mine.txt", odometry.trajectory, format="kitti")
    assert (tmp_path / "mine.txt").read_bytes() == (out / "poses_lidar.txt").read_bytes()
    rilo.write_poses(tmp_path / "mine.tum", odometry.trajectory, odometry.stamps_ns)
    assert (tmp_path / "mine.tum").read_bytes() == (out / "trajectory.tum").read_bytes()
    run = rilo.run(recording)
    assert np.array_equal(run.trajectory, odometry.trajectory) and np.array_equal(run.stamps_ns, odometry.stamps_ns)
    assert np.array_equal(rilo.run(recording, one_pass=True).trajectory, odometry.trajectory)


def test_a_run_is_observed(recording, capfd):
    seen = []
    run = rilo.run(recording, count=4, start=2, map_voxel_m=1, progress=True, on_sweep=lambda *seen_now: seen.append(seen_now))
    assert [index for index, *_ in seen] == run.indices == [2, 3, 4, 5] and len(run) == 4
    assert [result.stamp_ns for _, result, _ in seen] == run.stamps_ns.tolist()
    assert all(len(sweep) == result.points_in for _, result, sweep in seen)
    assert np.array_equal(seen[-1][1].pose, run.trajectory[-1]) and np.array_equal(run.results[-1].pose, run.trajectory[-1])
    assert len(run.map) > 500 and run.map.dtype == np.float32 and run.started_over_after is None
    assert "4/4 sweeps" in capfd.readouterr().err
    assert run.wall_s > 0 and "voxel_m" in run.config and run.warnings == []
    assert "of 4 sweeps" in repr(run) and "4, " in run._repr_html_()
    assert len(rilo.run(recording, count=2).map) == 0


def test_a_run_restarts_with_the_elevation_offset(tmp_path):
    drive = tmp_path / "drive"
    made = command("simulate", "--out", drive, "--sensor", "hdl64", "--sweeps", "30", "--start", "10",
                   "--elevation-bias", "0.3", "--quiet")  # fmt: skip
    assert made.returncode == 0, made.stderr
    restarts = []
    run = rilo.run(drive, on_restart=lambda *seen: restarts.append(seen))
    assert len(run) == 30 and len(restarts) == 1
    assert restarts[0][0] == run.started_over_after and restarts[0][1] > 0.1
    single = rilo.run(drive, one_pass=True)
    assert single.started_over_after is None and not np.array_equal(single.trajectory, run.trajectory)
    assert "restarted after" in run._repr_html_()


def test_a_run_has_the_options_of_open_and_refuses_others(recording, tmp_path):
    bins = tmp_path / "bins"
    bins.mkdir()
    for i, sweep in enumerate(list(rilo.open(recording))[:3]):
        sweep.points.tofile(bins / f"{i}.bin")
    run = rilo.run(bins, bin_fields="x,y,z", rate=20, point_times="none")
    assert np.diff(run.stamps_ns).tolist() == [50_000_000] * 2
    with pytest.raises(TypeError, match="unknown option 'topics'; known: topic, "):
        rilo.run(bins, topics="/points")
    with pytest.raises(TypeError, match="unknown option 'unit'"):
        rilo.open(bins, unit="s")
    with pytest.raises(rilo.IoError, match="no sweep to run"):
        rilo.run(bins, bin_fields="x,y,z", start=7)
    with pytest.raises(rilo.IoError, match="nowhere"):
        rilo.run(tmp_path / "nowhere")
    with pytest.raises(rilo.ConfigError, match="voxel"):
        rilo.run(bins, settings={"map.voxel": 1})
    with pytest.raises(ValueError, match="map_voxel_m: got 0"):
        rilo.run(bins, bin_fields="x,y,z", map_voxel_m=0)


def test_an_exception_of_an_observer_ends_the_run(recording):
    seen = []

    def second_is_bad(index, *_):
        seen.append(index)
        if index == 1:
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        rilo.run(recording, on_sweep=second_is_bad)
    assert seen == [0, 1]


def test_ctrl_c_ends_the_run(recording):
    seen = []

    def interrupted(index, *_):
        seen.append(index)
        if index == 2:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # as on a terminal, wherever the tests run
    try:
        with pytest.raises(KeyboardInterrupt):
            rilo.run(recording, on_sweep=interrupted)
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen[-1] in (2, 3)


EXAMPLES = Path(__file__).parent.parent / "examples"


def test_the_examples_run(tmp_path, recording):
    done = subprocess.run([sys.executable, EXAMPLES / "minimal.py", recording], capture_output=True, text=True, check=True)
    assert "points in the local map" in done.stdout
    written = tmp_path / "poses.txt"
    done = subprocess.run([sys.executable, EXAMPLES / "write_poses.py", recording, written], capture_output=True, text=True, check=True)  # fmt: skip
    assert f"after {SWEEPS} sweeps" in done.stdout
    assert np.array_equal(rilo.read_poses(written, "kitti").shape, (SWEEPS, 4, 4))


BESIDE = EXAMPLES / "beside_kiss_icp.py"


def test_without_kiss_icp_a_sentence_says_so():
    without = "import runpy, sys; sys.modules['kiss_icp'] = None; runpy.run_path(sys.argv[1], run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", without, BESIDE], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and done.stderr == "KISS-ICP is not installed: pip install kiss-icp\n"


def test_beside_kiss_icp(recording):
    pytest.importorskip("kiss_icp")
    done = subprocess.run([sys.executable, BESIDE, "--sweeps", "4"], capture_output=True, text=True, check=True)
    assert "4 sweeps of " in done.stdout
    rows = re.findall(r"^(rilo|kiss-icp) \S+ +([\d.]+) ms a sweep .*APE ([\d.]+) m", done.stdout, re.MULTILINE)
    assert [name for name, *_ in rows] == ["rilo", "kiss-icp"]
    assert all(float(ms) > 0 for _, ms, _ in rows) and float(rows[0][2]) < 0.05
    no_truth = subprocess.run([sys.executable, BESIDE, recording], capture_output=True, text=True, check=False)
    assert no_truth.returncode == 2 and "TRUTH is missing" in no_truth.stderr
