#!/usr/bin/env python3
"""Puts faults into drives and counts poses that are wrong although their status vouches for them.

usage: fault_matrix.py PLAN WORK_FOLDER [--rilo COMMAND] [--peer kiss_icp] [--drives a,b] [--faults x,y] [--jobs 2] [--csv FILE]

PLAN is a JSON object, a drive a key:

  {"town": {"folder": "drives/town", "first": 60, "count": 60, "truth": "drives/town/poses_mid.txt",
            "foreign": "drives/elsewhere", "flags": ["--point-times", "azimuth"], "stride": 5}}

  folder   velodyne/*.bin (float32 x y z intensity); times_pt/*.bin, times.txt and meta.json where there are such
  first    first sweep that is used (0); count: so many (60)
  stride   fault `slow` is every stride-th sweep of the whole drive, which needs `truth`; without it the drive does not
           have that fault
  truth    poses of all sweeps of the folder, LiDAR frame, KITTI form, at the instant of the poses that the program
           gives. Without it the run without a fault is the truth: for real drives whose truth is noisier than that;
           they do not have the faults `stretches` and `long_gaps`
  times    times.txt, where it does not lie in the folder
  foreign  a folder whose sweeps are of a place elsewhere: the middle one is the foreign sweep
  flags    further flags of `rilo run`

Relative paths count from the folder of PLAN. Each fault goes into a copy (links to what is unchanged); `rilo run
--one-pass --threads 1` is run on it. With --peer kiss_icp KISS-ICP (pip install kiss-icp) is run instead, which says
nothing of its poses: only whether it goes on tracking counts.

What is counted. Odometry is relative: poses are compared with the truth from an anchor on, the first sweep of the map.
A sweep with status `initialising`, or the last of RESTART lost ones in a row, begins a new map and is the next anchor.
Status ok, degenerate and recovered vouch for a pose. Such a pose is wrong when it is off by more than
0.25 m or 2° beyond what a run without a fault is off at the same sweep, both from the same anchor: one of the same
sweeps, for faults of a longer piece of the drive one of that piece. A sweep of nowhere
(foreign, covered) that is vouched for is wrong unless its pose is that of the sweep that it replaces. `tracks`: the
last ten poses are right from the first of them on, and vouched for. Prints a table; --csv writes it.
"""
import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from fault_cases import FAULTS, MADE_OF, WITHOUT_FAULT, Drive, write_drive

LIMIT_M, LIMIT_DEG = 0.25, 2.0
RESTART = 10
TAIL = 10
VOUCHED = {"ok", "degenerate", "recovered"}


def run_rilo(command, drive, folder, out):
    """Pose (4x4) and status by place in the data."""
    flags = ["--one-pass", "--threads", "1", "--quiet", "--no-report"] + drive.flags
    done = subprocess.run([command, "run", folder, "--out", out] + flags, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{folder}: exit {done.returncode}: {done.stderr.strip()[-300:]}")
    poses = read_poses(os.path.join(out, "poses_lidar.txt"))
    with open(os.path.join(out, "sweeps.csv"), newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    return {int(row["sweep"]): (pose, row["status"]) for row, pose in zip(rows, poses)}


def run_kiss_icp(drive, folder):
    from kiss_icp.config import load_config
    from kiss_icp.kiss_icp import KissICP
    config = load_config(None)
    config.data.deskew, config.registration.max_num_threads = drive.timed, 1
    odometry, poses = KissICP(config), {}
    for k, name in enumerate(sorted(os.listdir(os.path.join(folder, "velodyne")))):
        points = np.fromfile(os.path.join(folder, "velodyne", name), np.float32).reshape(-1, 4)[:, :3]
        times = np.fromfile(os.path.join(folder, "times_pt", name), np.float32) if drive.timed else np.empty(0)
        seen = np.isfinite(points).all(axis=1)
        odometry.register_frame(points[seen].astype(float), times[seen].astype(float) if drive.timed else times)
        poses[k] = (np.array(odometry.last_pose), "ok")
    return poses


def read_poses(file):
    values = np.loadtxt(file, ndmin=2)
    poses = np.tile(np.eye(4), (len(values), 1, 1))
    poses[:, :3, :] = values.reshape(-1, 3, 4)
    return poses


# ---- comparison ----

def error(truth, anchor_true, pose, anchor):
    """Metres and degrees between the motions from the anchor on."""
    E = np.linalg.inv(np.linalg.inv(anchor_true) @ truth) @ (np.linalg.inv(anchor) @ pose)
    turn = np.arccos(np.clip((np.trace(E[:3, :3]) - 1.0) / 2.0, -1.0, 1.0))
    return float(np.linalg.norm(E[:3, 3])), float(np.degrees(turn))


def judge(sweeps, found, truth, faultless):
    """Figures of one run; `truth` and `faultless` are poses by number of the sweep in the drive's folder."""
    row = {"poses": len(found), "vouched": 0, "wrong": 0, "wrong_steps": 0, "worst_m": 0.0, "worst_deg": 0.0, "lost": 0}
    anchor = last = None
    lost_in_a_row, wrong_before, where = 0, False, []
    for k in sorted(found):
        pose, status = found[k]
        number = sweeps[k].truth
        row["lost"] += status == "lost"
        lost_in_a_row = lost_in_a_row + 1 if status in ("lost", "empty") else 0
        if anchor is None or status == "initialising" or lost_in_a_row == RESTART:
            anchor = last = (pose, number)
            wrong_before = False
            continue
        if status not in VOUCHED:
            continue
        row["vouched"] += 1
        metres, degrees = error(truth[number], truth[anchor[1]], pose, anchor[0])
        base_m = base_deg = 0.0
        if number in faultless and anchor[1] in faultless:
            base_m, base_deg = error(truth[number], truth[anchor[1]], faultless[number], faultless[anchor[1]])
        wrong = metres > LIMIT_M + base_m or degrees > LIMIT_DEG + base_deg
        if wrong:
            row["wrong"] += 1
            row["worst_m"], row["worst_deg"] = max(row["worst_m"], metres), max(row["worst_deg"], degrees)
        step_m, step_deg = error(truth[number], truth[last[1]], pose, last[0])
        if step_m > LIMIT_M or step_deg > LIMIT_DEG:
            row["wrong_steps"] += 1
        if wrong and not wrong_before:
            where.append(k)
        wrong_before = wrong
        last = (pose, number)
    row["first_wrong"] = " ".join(map(str, where[:4]))
    row["tracks"] = int(tracks(sweeps, found, truth))
    return row


def tracks(sweeps, found, truth):
    tail = sorted(found)[-TAIL:]
    start = (found[tail[0]][0], sweeps[tail[0]].truth)
    errors = [error(truth[sweeps[k].truth], truth[start[1]], found[k][0], start[0]) for k in tail]
    right = all(m < LIMIT_M and d < LIMIT_DEG for m, d in errors)
    return right and all(found[k][1] in VOUCHED for k in tail)


def work(task):
    drive, fault, options, truth, faultless = task
    folder = os.path.join(options.work, "data", drive.name, fault)
    out = os.path.join(options.work, "out", drive.name, fault)
    plain = drive.plain()
    sweeps = {**WITHOUT_FAULT, **FAULTS}[fault](drive, plain, len(plain) // 2)
    if sweeps is None:
        return None
    write_drive(drive, sweeps, folder)
    try:
        found = run_kiss_icp(drive, folder) if options.peer else run_rilo(options.rilo, drive, folder, out)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    poses = {sweeps[k].truth: pose for k, (pose, _) in found.items()}
    if truth is None:
        truth = poses
    return poses, {"drive": drive.name, "fault": fault, **judge(sweeps, found, truth, faultless)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan")
    parser.add_argument("work")
    parser.add_argument("--rilo", default="rilo")
    parser.add_argument("--peer", choices=["kiss_icp"])
    parser.add_argument("--drives")
    parser.add_argument("--faults")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--csv")
    options = parser.parse_args()
    with open(options.plan, encoding="utf-8") as text:
        plan = json.load(text)
    base = os.path.dirname(os.path.abspath(options.plan))
    drives = [Drive(n, e, base) for n, e in plan.items() if not options.drives or n in options.drives.split(",")]
    for drive in drives:
        if drive.stride and not drive.truth_file:
            sys.exit(f"{options.plan}: {drive.name} has a stride and no truth; give `truth`, poses of all its sweeps")
    faults = [f for f in FAULTS if not options.faults or f in options.faults.split(",")]
    rows = []
    with ProcessPoolExecutor(options.jobs) as pool:
        truths = {d.name: dict(enumerate(read_poses(d.truth_file))) if d.truth_file else None for d in drives}
        needed = {"none"} | {MADE_OF[f] for f in faults if f in MADE_OF}
        pieces = [(d, piece) for d in drives for piece in sorted(needed if d.truth_file else {"none"})]
        done = list(pool.map(work, [(d, piece, options, truths[d.name], {}) for d, piece in pieces]))
        sound = {(d.name, piece): poses for (d, piece), (poses, _) in zip(pieces, done)}
        rows += [row for _, row in done]
        tasks = []
        for drive in drives:
            truth = truths[drive.name] or sound[drive.name, "none"]
            for fault in faults:
                faultless = sound.get((drive.name, MADE_OF.get(fault, "none")), {})
                tasks.append((drive, fault, options, truth, faultless))
        for done in pool.map(work, tasks):
            if done:
                rows.append(done[1])
                show(done[1])
    summarise(rows)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
            table.writeheader()
            table.writerows(rows)


def show(row):
    print("{drive:12s} {fault:15s} wrong {wrong:3d} (steps {wrong_steps}) of {vouched:3d} vouched, lost {lost:2d}, "
          "worst {worst_m:.2f} m {worst_deg:.1f} deg, tracks {tracks} {first_wrong}".format(**row), flush=True)


def summarise(rows):
    faulty = [row for row in rows if row["fault"] not in WITHOUT_FAULT]
    for row in rows:
        if row["fault"] in WITHOUT_FAULT:
            show(row)
    print(f"{len(faulty)} runs: {sum(r['wrong'] for r in faulty)} poses wrong and vouched for, "
          f"in {sum(r['wrong'] > 0 for r in faulty)} runs; {sum(r['tracks'] for r in faulty)} track to the end")


if __name__ == "__main__":
    sys.exit(main())
