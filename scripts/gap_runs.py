#!/usr/bin/env python3
"""Runs a drive again and again, each time with one gap, and says where it is found again.

usage: gap_runs.py DRIVE WORK_FOLDER [--rilo COMMAND] [--every 7] [--gaps 10,15,20]
                   [--flags="--point-times azimuth"]

DRIVE has velodyne/*.bin, and times.txt, times_pt/*.bin, meta.json and calib.txt where there are such. Each run, with
--one-pass, has 20 sweeps, then so many are missing, then six more; runs start `--every` sweeps apart. The run of the
whole drive is the truth, so that real drives serve. The sensor is found again when the pose of the sixth sweep is off by
less than 0.5 m from the last sweep before the gap on.
"""
import argparse
import csv
import os
import shlex
import shutil
import subprocess
import sys

import numpy as np

from fault_matrix import read_poses

BEFORE, AFTER, LIMIT_M = 20, 6, 0.5
VOUCHED = {"ok", "degenerate", "recovered"}


def run(options, folder, out):
    command = [options.rilo, "run", folder, "--out", out, "--one-pass", "--quiet", "--no-report"] + options.flags
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{folder}: exit {done.returncode}: {done.stderr.strip()[-300:]}")
    with open(os.path.join(out, "sweeps.csv"), newline="", encoding="utf-8") as lines:
        return read_poses(os.path.join(out, "poses_lidar.txt")), [row["status"] for row in csv.DictReader(lines)]


def link(drive, names, stamps, numbers, folder):
    """A drive of these sweeps of another."""
    shutil.rmtree(folder, ignore_errors=True)
    for kind in ("velodyne", "times_pt"):
        if not os.path.isdir(os.path.join(drive, kind)):
            continue
        os.makedirs(os.path.join(folder, kind))
        for k, i in enumerate(numbers):
            source = os.path.abspath(os.path.join(drive, kind, names[i]))
            os.symlink(source, os.path.join(folder, kind, f"{k:06d}.bin"))
    np.savetxt(os.path.join(folder, "times.txt"), stamps[numbers], fmt="%.6f")
    for name in ("meta.json", "calib.txt"):
        if os.path.exists(os.path.join(drive, name)):
            shutil.copy(os.path.join(drive, name), folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive")
    parser.add_argument("work")
    parser.add_argument("--rilo", default="rilo")
    parser.add_argument("--every", type=int, default=7)
    parser.add_argument("--gaps", default="10,15,20")
    parser.add_argument("--flags", default="", type=shlex.split, help="further ones of `rilo run`")
    options = parser.parse_args()
    names = sorted(os.listdir(os.path.join(options.drive, "velodyne")))
    times = os.path.join(options.drive, "times.txt")
    stamps = np.loadtxt(times) if os.path.exists(times) else 0.1 * np.arange(len(names))
    truth, _ = run(options, options.drive, os.path.join(options.work, "whole"))
    runs = found = at_once = wrong = 0
    for gap in map(int, options.gaps.split(",")):
        for at in range(BEFORE + 5, len(names) - gap - AFTER + 1, options.every):
            numbers = [*range(at - BEFORE, at), *range(at + gap, at + gap + AFTER)]
            folder = os.path.join(options.work, "data")
            link(options.drive, names, stamps, numbers, folder)
            poses, status = run(options, folder, os.path.join(options.work, "out"))
            true = np.linalg.inv(truth[at - 1]) @ truth[numbers[-1]]
            off = np.linalg.inv(true) @ np.linalg.inv(poses[BEFORE - 1]) @ poses[-1]
            metres = float(np.linalg.norm(off[:3, 3]))
            runs += 1
            found += metres < LIMIT_M
            at_once += metres < LIMIT_M and status[BEFORE] in VOUCHED
            # What a new map vouches for counts from its beginning on.
            wrong += metres >= LIMIT_M and set(status[BEFORE:]) <= VOUCHED | {"lost"} and status[-1] in VOUCHED
            if metres >= LIMIT_M:
                print(f"sweep {at}, {gap} missing: {metres:.1f} m off, {' '.join(status[BEFORE:])}")
    print(f"{runs} gaps: {found} found again, {at_once} of them with the first sweep; {wrong} wrong and vouched for")


if __name__ == "__main__":
    main()
