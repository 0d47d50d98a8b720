"""Whole runs, and the command that comes along."""

import copy
import os
import shutil
import signal

import numpy as np
import pytest
from conftest import command

import rilo


def test_the_command_comes_along():
    assert command("--version").stdout == f"rilo {rilo.__version__}\n"
    wrong = command("run")
    assert wrong.returncode == 2 and "rilo: error" in wrong.stderr


def test_the_command_gives_the_same_bits(tmp_path, recording):
    out = tmp_path / "out"
    ran = command("run", recording, "--out", out, "--one-pass", "--quiet")
    assert ran.returncode == 0, ran.stderr
    odometry = rilo.Odometry()

    def run_through():
        for sweep in rilo.open(recording):
            odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)

    run_through()
    rilo.write_poses(tmp_path / "mine.txt", odometry.trajectory, format="kitti")
    assert (tmp_path / "mine.txt").read_bytes() == (out / "poses_lidar.txt").read_bytes()
    rilo.write_poses(tmp_path / "mine.tum", odometry.trajectory, odometry.stamps_ns)
    assert (tmp_path / "mine.tum").read_bytes() == (out / "trajectory.tum").read_bytes()
    assert np.array_equal(rilo.run(recording, one_pass=True).trajectory, odometry.trajectory)
    assert odometry.start_over() == 0
    run_through()
    run = rilo.run(recording)
    assert np.array_equal(run.trajectory, odometry.trajectory) and np.array_equal(run.stamps_ns, odometry.stamps_ns)


def test_a_fork_does_not_wait_for_the_reader_of_its_parent(recording):
    source = rilo.open(recording)
    next(source)
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        good = False
        try:
            with pytest.raises(ValueError, match="another process"):
                next(source)
            assert "closed" in repr(source)
            source.close()
            del source
            good = len(list(rilo.open(recording))) > 1
        finally:
            os._exit(0 if good else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert len(list(source)) > 1


def test_a_run_is_observed(recording, capfd):
    seen = []
    run = rilo.run(recording, count=4, start=2, map_voxel_m=1, one_pass=True, progress=True,
                   on_sweep=lambda *seen_now: seen.append(seen_now))  # fmt: skip
    assert [index for index, *_ in seen] == run.indices == [2, 3, 4, 5] and len(run) == 4
    assert [result.stamp_ns for _, result, _ in seen] == run.stamps_ns.tolist()
    assert all(len(sweep) == result.points_in for _, result, sweep in seen)
    assert np.array_equal(seen[-1][1].pose, run.trajectory[-1]) and np.array_equal(run.results[-1].pose, run.trajectory[-1])
    assert len(run.map) > 500 and run.map.dtype == np.float32 and run.started_over_after is None
    assert "4/4 sweeps" in capfd.readouterr().err
    assert run.wall_s > 0 and "voxel_m" in run.config and run.warnings == []
    assert "of 4 sweeps" in repr(run) and "4, " in run._repr_html_()
    assert len(rilo.run(recording, count=2).map) == 0


def test_a_run_restarts_with_what_it_learnt_of_the_sensor(tmp_path):
    drive = tmp_path / "drive"
    made = command("simulate", "--out", drive, "--sensor", "hdl64", "--sweeps", "30", "--start", "10",
                   "--elevation-bias", "0.3", "--quiet")  # fmt: skip
    assert made.returncode == 0, made.stderr
    restarts = []
    run = rilo.run(drive, on_restart=lambda *seen: restarts.append(seen))
    assert len(run) == 30 and len(restarts) == 1
    assert restarts[0][0] == run.started_over_after == 30 and restarts[0][1] > 0.1
    single = rilo.run(drive, one_pass=True)
    assert single.started_over_after is None and not np.array_equal(single.trajectory, run.trajectory)
    assert "restarted after" in run._repr_html_()


def test_what_a_run_learns_of_the_sensor_is_used_by_others(recording, tmp_path):
    learnt = rilo.run(recording).calibration
    assert learnt.startswith("# ") and "elevation_offset_deg: 0.000000" in learnt and "beams:" in learnt
    (tmp_path / "calibration.yaml").write_text(learnt)
    run = rilo.run(recording, calibration=learnt, one_pass=True)
    same = rilo.run(recording, calibration=tmp_path / "calibration.yaml", one_pass=True)
    odometry = rilo.Odometry(calibration=str(tmp_path / "calibration.yaml"))
    for sweep in rilo.open(recording):
        odometry.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
    assert np.array_equal(run.trajectory, same.trajectory) and np.array_equal(run.trajectory, odometry.trajectory)
    assert "beams:" in odometry.calibration()
    assert any("learnt from this recording" in warning for warning in run.warnings)

    other = rilo.Odometry(calibration="elevation_offset_deg: 0\nbeams: [[3, 80, 0, 0]]\n...")
    sweep = next(iter(rilo.open(recording)))
    with pytest.raises(ValueError, match="of another sensor"):
        other.register(sweep.points, sweep.times_s, sweep.stamp_ns, sweep.rings)
    with pytest.raises(rilo.ConfigError, match="no such file"):
        rilo.Odometry(calibration="nowhere.yaml")
    with pytest.raises(TypeError, match="calibration"):
        rilo.run(recording, calibration=3)


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
    with pytest.raises(ValueError, match="map_voxel_m: got 0.0001; expected 0.001"):
        rilo.run(bins, bin_fields="x,y,z", map_voxel_m=1e-4)


@pytest.mark.parametrize("options, error, message", [
    ({"count": -1}, ValueError, "count: got -1; expected a number from 0"),
    ({"start": 2.0}, TypeError, "start: got 2.0 of type float; expected a whole number"),
    ({"rate": "10"}, TypeError, "rate: got '10' of type str; expected a number"),
    ({"topic": None}, TypeError, "topic: got None of type NoneType; expected text"),
    ({"bin_fields": ["x", "y"]}, TypeError, r"bin_fields: got \['x', 'y'\] of type list; expected text"),
    ({"skip_bad_sweeps": "no"}, TypeError, "skip_bad_sweeps: got 'no' of type str; expected True or False"),
    ({"sensor_file": 3}, TypeError, "sensor_file: got 3 of type int"),
    ({"map_voxel_m": "1"}, TypeError, "map_voxel_m: got '1' of type str; expected a number or None"),
    ({"on_sweep": 3}, TypeError, "on_sweep: got 3 of type int; expected a function or None"),
])  # fmt: skip
def test_what_an_option_cannot_be_is_said(recording, options, error, message):
    with pytest.raises(error, match=message):
        rilo.run(recording, **options)


def test_what_is_no_path_is_said(recording):
    for call in rilo.open, rilo.run:
        with pytest.raises(TypeError, match="(path|source): got None of type NoneType; expected a path"):
            call(None)
    options = {"rate": np.float32(5), "skip_bad_sweeps": np.bool_(True), "sensor_file": recording}
    assert len(rilo.open(str(recording).encode(), **options)) == len(rilo.open(recording))
    assert len(rilo.run(recording, count=np.int64(2))) == 2


def test_results_of_a_run_are_there_once(recording):
    run = rilo.run(recording, count=3)
    assert run.results is run.results and run.map is run.map and run.map.shape == (0, 3)
    for copied in (copy.copy(run.results[2]), copy.deepcopy(run.results)[2]):
        assert np.array_equal(copied.pose, run.trajectory[2]) and copied is not run.results[2]


def test_an_exception_of_an_observer_ends_the_run(recording, capfd):
    seen = []

    def second_is_bad(index, *_):
        seen.append(index)
        if index == 1:
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        rilo.run(recording, on_sweep=second_is_bad, progress=True)
    assert seen == [0, 1]
    assert capfd.readouterr().err.endswith("\n")  # the line of the progress is ended


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


# Whether points without times are raw is tried before the first sweep.
def test_ctrl_c_during_the_trial_ends_the_run(tmp_path, recording):
    untimed = tmp_path / "untimed"
    shutil.copytree(recording, untimed, ignore=shutil.ignore_patterns("times_pt"))
    seen = []
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            rilo.run(untimed, on_sweep=lambda *now: seen.append(now))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert seen == []
