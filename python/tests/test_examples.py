"""The examples, as they are."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import SWEEPS

import rilo


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
