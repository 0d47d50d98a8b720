#!/usr/bin/env python3
"""A long run of `rilo run`: a drive there and back as often as it takes, and what the process holds on the way.

usage: soak.py RILO DRIVE OUT [--sweeps 20000] [--every 500] [--threads 0]

DRIVE is a folder of the KITTI layout without times (rilo simulate --deskewed, say); OUT gets links to its sweeps and the
results. Prints a table: milliseconds a sweep, resident memory, open files and threads; exit code 1 if the last tenth of
the run holds more files or threads than the tenth after the first, or more memory than the results of the sweeps
between, which are kept until the end (1.5 kB a sweep), and 5 MiB.
"""
import argparse
import csv
import os
import subprocess
import sys
import time
from pathlib import Path

from process_watch import print_growth, state_of, table, there_and_back

MEMORY_SLACK_MB = 5.0
RESULT_MB = 1.5 / 1024


def link_there_and_back(drive, folder, sweeps):
    files = sorted(Path(drive, "velodyne").resolve().glob("*.bin"))
    if len(files) < 2:
        sys.exit(f"soak.py: {drive}/velodyne has {len(files)} .bin files; two at least are needed")
    target = folder / "velodyne"
    target.mkdir(parents=True, exist_ok=True)
    for i, file in zip(range(sweeps), there_and_back(files)):
        link = target / f"{i:06d}.bin"
        link.unlink(missing_ok=True)
        link.symlink_to(file)
    (folder / "times.txt").write_text("".join(f"{0.1 * i:.1f}\n" for i in range(sweeps)))


def lines_of(path):
    try:
        with open(path, "rb") as file:
            return sum(block.count(b"\n") for block in iter(lambda: file.read(1 << 20), b""))
    except FileNotFoundError:
        return 0


def watch(process, partial, every):
    states = {}
    while process.poll() is None:
        done = lines_of(partial)
        if done // every > len(states):
            state = state_of(process.pid)
            if state:
                states[len(states) * every + every] = state
        time.sleep(0.2)
    return states


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rilo")
    parser.add_argument("drive")
    parser.add_argument("out", type=Path)
    parser.add_argument("--sweeps", type=int, default=20000)
    parser.add_argument("--every", type=int, default=500)
    parser.add_argument("--threads", default="0", help="of the odometry; 0: all")
    arguments = parser.parse_args()

    data, results = arguments.out / "data", arguments.out / "results"
    link_there_and_back(arguments.drive, data, arguments.sweeps)
    process = subprocess.Popen([arguments.rilo, "run", data, "--out", results, "--threads", arguments.threads, "--quiet",
                                "--no-report", "--one-pass"],
                               env={**os.environ, "LC_ALL": "C"})
    states = watch(process, results / "poses_lidar.partial.txt", arguments.every)
    if process.returncode != 0:
        sys.exit(f"soak.py: rilo run ended with {process.returncode}")
    with open(results / "sweeps.csv", newline="", encoding="utf-8") as file:
        total_ms = [float(row["total_ms"]) for row in csv.DictReader(file)]
    rows = [(n, sum(total_ms[n - arguments.every:n]) / arguments.every, state) for n, state in sorted(states.items())]
    print("\n".join(table(rows)))
    memory, files, threads = print_growth(rows)
    kept = MEMORY_SLACK_MB + RESULT_MB * arguments.sweeps
    sys.exit(int(memory > kept or files > 0 or threads > 0))


if __name__ == "__main__":
    main()
