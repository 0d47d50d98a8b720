#!/usr/bin/env python3
"""Runs a drive again and again, each time with one gap, and says where it is found again.

usage: gap_runs.py DRIVE WORK_FOLDER [--rilo COMMAND] [--every 7] [--gaps 10,15,20]
                   [--unstamped] [--flags="--point-times azimuth"]

DRIVE is a `folder` as in the plans of fault_matrix.py, and is run as there. Each run has 20 sweeps, then so many are
missing, then six more; runs start `--every` sweeps apart. With --unstamped their data has no stamps. The run of the
whole drive is the truth, so that real drives serve. The sensor is found again when the pose of the sixth sweep is off
by less than 0.5 m from the last sweep before the gap on.
"""
import argparse
import os
import shlex

from fault_cases import Drive, copied, write_drive
from fault_matrix import VOUCHED, error, run_rilo

BEFORE, AFTER, LIMIT_M = 20, 6, 0.5
MANY = 1_000_000  # all sweeps


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive")
    parser.add_argument("work")
    parser.add_argument("--rilo", default="rilo")
    parser.add_argument("--every", type=int, default=7)
    parser.add_argument("--gaps", default="10,15,20")
    parser.add_argument("--unstamped", action="store_true")
    parser.add_argument("--flags", default="", type=shlex.split, help="further ones of `rilo run`")
    options = parser.parse_args()
    drive = Drive("drive", {"folder": options.drive, "flags": options.flags, "count": MANY}, ".")
    data, out = os.path.join(options.work, "data"), os.path.join(options.work, "out")
    truth = run_rilo(options.rilo, drive, drive.folder, out)
    sweeps = drive.plain()
    runs = found = at_once = wrong = 0
    for gap in map(int, options.gaps.split(",")):
        for at in range(BEFORE + 5, len(sweeps) - gap - AFTER + 1, options.every):
            last = at + gap + AFTER
            used = sweeps[at - BEFORE:at] + sweeps[at + gap:last]
            write_drive(drive, [copied(s, stamp=None) for s in used] if options.unstamped else used, data)
            results = run_rilo(options.rilo, drive, data, out)
            after = [results[k][1] for k in range(BEFORE, BEFORE + AFTER)]
            metres, _ = error(truth[last - 1][0], truth[at - 1][0], results[BEFORE + AFTER - 1][0], results[BEFORE - 1][0])
            runs += 1
            found += metres < LIMIT_M
            at_once += metres < LIMIT_M and after[0] in VOUCHED
            # What a new map vouches for counts from its beginning on.
            wrong += metres >= LIMIT_M and set(after) <= VOUCHED | {"lost"} and after[-1] in VOUCHED
            if metres >= LIMIT_M:
                print(f"sweep {at}, {gap} missing: {metres:.1f} m off, {' '.join(after)}")
    print(f"{runs} gaps: {found} found again, {at_once} of them with the first sweep; {wrong} wrong and vouched for")


if __name__ == "__main__":
    main()
