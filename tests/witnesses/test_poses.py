"""evo reads Rilo's trajectories and finds its errors."""

import copy
import json

import numpy as np
import pytest
from conftest import SWEEPS, rilo
from evo.core import metrics
from evo.core.trajectory import PoseTrajectory3D
from evo.core.units import Unit
from evo.tools import file_interface

TOLERANCE = 1e-6


@pytest.fixture(name="truth", scope="module")
def fixture_truth(run):
    return file_interface.read_kitti_poses_file(str(run.drive / "poses_mid.txt"))


@pytest.fixture(name="estimate", scope="module")
def fixture_estimate(run):
    return file_interface.read_kitti_poses_file(str(run.results / "poses_lidar.txt"))


def test_all_forms_hold_the_same_poses(run, estimate):
    tum = file_interface.read_tum_trajectory_file(str(run.results / "trajectory.tum"))
    euroc = file_interface.read_euroc_csv_trajectory(str(run.results / "trajectory.csv"))
    assert tum.num_poses == euroc.num_poses == estimate.num_poses == SWEEPS
    for trajectory in (tum, euroc, estimate):
        valid, details = trajectory.check()
        assert valid, details
    for trajectory in (tum, euroc):
        assert np.allclose(trajectory.positions_xyz, estimate.positions_xyz, rtol=0, atol=1e-8)
        assert np.allclose(np.array(trajectory.poses_se3), np.array(estimate.poses_se3), rtol=0, atol=1e-8)
    assert np.allclose(tum.timestamps, euroc.timestamps, rtol=0, atol=1e-9)


def evo_error(metric, truth, estimate, align):
    truth, estimate = copy.deepcopy(truth), copy.deepcopy(estimate)
    if align:
        estimate.align(truth)
    metric.process_data((truth, estimate))
    return metric.get_all_statistics()


def expect_equal(own, evo):
    assert own["max"] > 0
    for name in ("rmse", "mean", "std", "median", "max"):
        assert own[name] == pytest.approx(evo[name], rel=TOLERANCE, abs=1e-9), name


def test_errors_are_those_of_evo(run, truth, estimate):
    own = json.loads(rilo("eval", run.drive, run.results / "poses_lidar.txt", "--json"))
    relation = metrics.PoseRelation
    expect_equal(own["ape_m"], evo_error(metrics.APE(relation.translation_part), truth, estimate, True))
    expect_equal(own["ape_rotation_deg"], evo_error(metrics.APE(relation.rotation_angle_deg), truth, estimate, True))
    per_frame = {"delta": 1, "delta_unit": Unit.frames}
    expect_equal(
        own["rpe_frame_m"], evo_error(metrics.RPE(relation.translation_part, **per_frame), truth, estimate, False)
    )
    expect_equal(
        own["rpe_frame_deg"], evo_error(metrics.RPE(relation.rotation_angle_deg, **per_frame), truth, estimate, False)
    )


def test_stamped_poses_of_evo_are_read(run, truth, tmp_path):
    """Truth that evo writes with stamps, a part of it missing: both pair by stamp."""
    tum = file_interface.read_tum_trajectory_file(str(run.results / "trajectory.tum"))
    stamped = PoseTrajectory3D(poses_se3=truth.poses_se3, timestamps=tum.timestamps)
    keep = [i for i in range(SWEEPS) if i not in (2, 3, 9)]
    stamped.reduce_to_ids(keep)
    tum.reduce_to_ids(keep)
    file_interface.write_tum_trajectory_file(str(tmp_path / "truth.tum"), stamped)
    own = json.loads(rilo("eval", tmp_path / "truth.tum", run.results / "trajectory.tum", "--json"))
    assert own["poses"] == len(keep)
    expect_equal(own["ape_m"], evo_error(metrics.APE(metrics.PoseRelation.translation_part), stamped, tum, True))
