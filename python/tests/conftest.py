"""What the tests of the package share: a simulated drive, in memory and as a folder."""

import subprocess
import sys

import pytest

import rilo


SWEEPS = 12


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "rilo", *arguments], capture_output=True, text=True, check=False)


@pytest.fixture(scope="session")
def drive():
    simulator = rilo.Simulator(sensor="vlp16", sweeps=SWEEPS, start_s=4.0)
    assert len(simulator) == SWEEPS
    return [simulator.sweep(i) for i in range(SWEEPS)]


@pytest.fixture(scope="session")
def run(drive):
    odometry = rilo.Odometry()
    return odometry, [odometry.register(points, times, stamp) for points, times, stamp, _ in drive]


@pytest.fixture(scope="session")
def recording(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recording") / "drive"
    made = command("simulate", "--out", folder, "--sensor", "vlp16", "--start", "4", "--sweeps", str(SWEEPS), "--quiet")
    assert made.returncode == 0, made.stderr
    return folder
