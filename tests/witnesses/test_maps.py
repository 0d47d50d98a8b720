"""plyfile reads Rilo's maps, and Rilo the clouds of plyfile."""

import numpy as np
import pytest
from conftest import rilo, sweeps_in
from plyfile import PlyData, PlyElement


def test_a_map_with_normals_and_intensities(run):
    vertices = PlyData.read(str(run.results / "map.ply"))["vertex"]
    names = [entry.name for entry in vertices.properties]
    assert names[:3] == ["x", "y", "z"] and {"nx", "ny", "nz", "intensity"} <= set(names)
    points = np.stack([vertices[name] for name in "xyz"], axis=1)
    assert points.dtype == np.float32 and len(points) > 5000
    assert np.isfinite(points).all()
    # One point per voxel of 0.2 m.
    voxels = np.unique(np.floor(points.astype(np.float64) / 0.2), axis=0)
    assert len(voxels) > 0.99 * len(points)
    normals = np.stack([vertices[name] for name in ("nx", "ny", "nz")], axis=1)
    lengths = np.linalg.norm(normals, axis=1)
    assert np.all((np.abs(lengths - 1) < 1e-5) | (lengths == 0)) and np.mean(lengths > 0.5) > 0.5
    assert np.isfinite(vertices["intensity"]).all()


def test_ply_and_pcd_maps_hold_the_same_points(run, tmp_path):
    for name in ("map.ply", "map.pcd"):
        rilo("run", run.drive, "--out", tmp_path / "out", "--map", tmp_path / name, "--quiet", "--no-report")
    vertices = PlyData.read(str(tmp_path / "map.ply"))["vertex"]
    points = np.stack([vertices[name] for name in "xyz"], axis=1)
    head, _, body = (tmp_path / "map.pcd").read_bytes().partition(b"DATA binary\n")
    assert f"POINTS {len(points)}\n".encode() in head
    assert np.array_equal(np.frombuffer(body, np.float32).reshape(-1, 3), points)


@pytest.mark.parametrize("text", [False, True], ids=["binary", "ascii"])
@pytest.mark.parametrize("order", ["<", ">"], ids=["little", "big"])
def test_clouds_of_plyfile_are_read(tmp_path, text, order):
    random = np.random.default_rng(5)
    data = np.zeros(300, [(name, "f4") for name in ("x", "y", "z", "intensity")] + [("ring", "u2")])
    for name in ("x", "y", "z", "intensity"):
        data[name] = random.uniform(-20, 20, len(data)).astype(np.float32)
    data["ring"] = random.integers(0, 64, len(data))
    path = tmp_path / "1.ply"
    PlyData([PlyElement.describe(data, "vertex")], text=text, byte_order=order).write(str(path))
    (sweep,) = sweeps_in(path, tmp_path)
    assert np.array_equal(sweep.points, np.stack([data[name] for name in "xyz"], axis=1))
    assert np.array_equal(sweep.intensities, data["intensity"])
    assert np.array_equal(sweep.rings, data["ring"])
