"""What the tests share: the command, the sweeps that Rilo reads, one drive and its results."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np
import pytest


def rilo(*arguments) -> str:
    """Standard output of the command; a failure shows its errors."""
    done = subprocess.run([os.environ["RILO_BIN"], *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@dataclass
class Sweep:
    stamp_ns: int
    points: np.ndarray
    times_s: Optional[np.ndarray]
    rings: Optional[np.ndarray]
    intensities: Optional[np.ndarray]


def sweeps_in(path: Path, folder: Path) -> list[Sweep]:
    """As Rilo reads them; skips where the build has no Python package, or no ROS 1 bags and `path` is one."""
    if "RILO_PYTHON" not in os.environ:
        pytest.skip("built without the Python package")
    out = folder / "sweeps.npz"
    done = subprocess.run(
        [os.environ["RILO_PYTHON"], str(Path(__file__).parent / "dump_sweeps.py"), str(path), str(out)],
        env={**os.environ, "PYTHONPATH": os.environ["RILO_PYTHONPATH"]},
        capture_output=True,
        text=True,
        check=False,
    )
    if "which this build cannot read" in done.stderr:
        pytest.skip("built without librosbag-storage")
    assert done.returncode == 0, done.stderr
    arrays = np.load(out)
    names = {"points": "points", "times_s": "times", "rings": "rings", "intensities": "intensities"}
    return [
        Sweep(
            int(arrays[f"stamp_{i}"]),
            **{to: arrays.get(f"{name}_{i}") for to, name in names.items()},
        )
        for i in range(int(arrays["count"]))
    ]


SWEEPS = 14


@dataclass
class Run:
    drive: Path
    results: Path


@pytest.fixture(scope="session")
def run(tmp_path_factory) -> Run:
    """A simulated drive of a VLP-16 and what `rilo run` leaves of it."""
    folder = tmp_path_factory.mktemp("run")
    drive, results = folder / "drive", folder / "results"
    rilo("simulate", "--out", drive, "--sensor", "vlp16", "--start", 10, "--sweeps", SWEEPS, "--quiet")
    rilo(
        *("run", drive, "--out", results, "--map", results / "map.ply", "--map-normals", "--map-intensity", "--quiet"),
        *("--odom-frame", "map", "--lidar-frame", "top_lidar"),
    )
    return Run(drive, results)
