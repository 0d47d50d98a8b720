"""Drives with faults, for fault_matrix.py: each fault makes a faulty list from the sweeps of a drive."""
import os
import shutil

import numpy as np

LONG = 150  # sweeps of `long_gaps`, its gaps included


class Drive:
    """What the plan says of a drive; a sweep is known by its number in the folder."""

    def __init__(self, name, entry, base):
        place = lambda key: os.path.normpath(os.path.join(base, entry[key])) if key in entry else None
        self.name, self.folder, self.foreign = name, place("folder"), place("foreign")
        self.truth_file, self.flags = place("truth"), entry.get("flags", [])
        self.first, self.count, self.stride = entry.get("first", 0), entry.get("count", 60), entry.get("stride")
        self.files = sorted(os.listdir(os.path.join(self.folder, "velodyne")))
        self.timed = os.path.isdir(os.path.join(self.folder, "times_pt"))
        times = place("times") or os.path.join(self.folder, "times.txt")
        self.stamps = np.loadtxt(times) if os.path.exists(times) else 0.1 * np.arange(len(self.files))

    def plain(self):
        return self.sweeps(self.first, self.first + self.count)

    def sweeps(self, first, last):
        return [Entry(self, i, self.stamps[i]) for i in range(first, min(last, len(self.files)))]


class Entry:
    """One sweep of a faulty drive."""

    def __init__(self, drive, number, stamp, edit=None, foreign=False):
        self.number, self.truth, self.stamp, self.edit, self.foreign = number, number, stamp, edit, foreign
        folder = drive.foreign if foreign else drive.folder
        files = sorted(os.listdir(os.path.join(folder, "velodyne"))) if foreign else drive.files
        self.points = os.path.join(folder, "velodyne", files[number])
        self.times = os.path.join(folder, "times_pt", files[number]) if drive.timed else None

    def write(self, folder, k):
        name = f"{k:06d}.bin"
        targets = [(self.points, os.path.join(folder, "velodyne", name))]
        if self.times:
            targets.append((self.times, os.path.join(folder, "times_pt", name)))
        if self.edit is None:
            for source, target in targets:
                os.symlink(os.path.abspath(source), target)
            return
        points = np.fromfile(self.points, np.float32).reshape(-1, 4)
        times = np.fromfile(self.times, np.float32) if self.times else np.zeros(len(points), np.float32)
        for (_, target), values in zip(targets, self.edit(points, times)):
            values.astype(np.float32).tofile(target)


# ---- faults: from the sweeps of a drive, and the middle of them, to the faulty list; None: the drive cannot have it ----

def copied(entry, **changes):
    changed = Entry.__new__(Entry)
    changed.__dict__.update(entry.__dict__, **changes)
    return changed


def data_of(entry, other):
    """The data of `other` with the stamp of `entry`: its pose is the one at which the data were taken."""
    return copied(other, stamp=entry.stamp)


def foreign_at(k):
    def fault(drive, sweeps, middle):
        if not drive.foreign:
            return None
        at = middle if k is None else k
        number = len(os.listdir(os.path.join(drive.foreign, "velodyne"))) // 2
        strange = Entry(drive, number, sweeps[at].stamp, foreign=True)
        strange.truth = sweeps[at].truth
        return sweeps[:at] + [strange] + sweeps[at + 1:]
    return fault


def edited(edit, many=1):
    return lambda drive, sweeps, m: sweeps[:m] + [copied(s, edit=edit) for s in sweeps[m:m + many]] + sweeps[m + many:]


def early_gap(drive, sweeps, middle):
    return sweeps[:1] + [s for s in sweeps[1:] if s.stamp - sweeps[0].stamp > 1.05]


def unstamped_gap(drive, sweeps, middle):
    kept = sweeps[:middle] + sweeps[middle + 6:]
    return [copied(s, stamp=None) for s in kept]


def swapped(drive, sweeps, m):
    return sweeps[:m] + [data_of(sweeps[m], sweeps[m + 1]), data_of(sweeps[m + 1], sweeps[m])] + sweeps[m + 2:]


def reversed_order(drive, sweeps, m):
    piece = sweeps[m:m + 5]
    return sweeps[:m] + [data_of(a, b) for a, b in zip(piece, reversed(piece))] + sweeps[m + 5:]


def frozen(drive, sweeps, m):
    return sweeps[:m] + [data_of(s, sweeps[m]) for s in sweeps[m:m + 5]] + sweeps[m + 5:]


def doubled(drive, sweeps, m):
    return sweeps[:m] + [data_of(sweeps[m], sweeps[m - 1])] + sweeps[m + 1:]


def one_stamp_ahead(drive, sweeps, m):
    return sweeps[:m] + [copied(sweeps[m], stamp=sweeps[m].stamp + 1000.0)] + sweeps[m + 1:]


def clock_set(drive, sweeps, m):
    return sweeps[:m] + [copied(s, stamp=s.stamp + 100.0) for s in sweeps[m:]]


def slow(drive, sweeps, middle):
    if not drive.stride:
        return None
    numbers = range(drive.first % drive.stride, len(drive.files), drive.stride)
    return [Entry(drive, i, drive.stamps[i]) for i in numbers]


def stretches(drive, sweeps, middle):
    """Sweeps that somebody selected: a hundred in stretches of the drive in random order, stamped evenly; then its end."""
    if not drive.truth_file:
        return None
    rng = np.random.default_rng(1)
    last = len(drive.files) - 20
    numbers = []
    while len(numbers) < 100:
        begin = rng.integers(0, last)
        numbers += range(begin, min(begin + rng.integers(1, 11), last))
    numbers = numbers[:100] + list(range(last, len(drive.files)))
    return [Entry(drive, i, 0.1 * k) for k, i in enumerate(numbers)]


def long_gaps(drive, sweeps, middle):
    """From the first sweep that is used on, 150: without 1, 1.5 and 2 seconds of them."""
    kept = long_range(drive, sweeps, middle)
    if not drive.truth_file or len(kept) < LONG:
        return None
    return kept[:40] + kept[50:70] + kept[85:110] + kept[130:]


# ---- sweeps without a fault: those that a fault is made of ----

def as_used(drive, sweeps, middle):
    return sweeps


def long_range(drive, sweeps, middle):
    return drive.sweeps(drive.first, drive.first + LONG)


def whole_drive(drive, sweeps, middle):
    return drive.sweeps(0, len(drive.files))


# ---- edits of points ----

def cover(points, times):
    """A cloth over the sensor: everything within 2 m, nothing of the place is left."""
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    reach = np.linalg.norm(points[:, :3], axis=1, keepdims=True)
    cloth = 1.5 + 0.3 * np.sin(3.0 * azimuth) + np.random.default_rng(len(points)).normal(0.0, 0.01, len(points))
    covered = points.copy()
    covered[:, :3] *= cloth[:, None] / np.maximum(reach, 1e-3)
    return covered, times


def nothing_but_nan(points, times):
    lost = points.copy()
    lost[:, :3] = np.nan
    return lost, times


FAULTS = {
    "second_foreign": foreign_at(1),
    "foreign": foreign_at(None),
    "early_gap": early_gap,
    "gap_unstamped": unstamped_gap,
    "gap": lambda drive, sweeps, m: sweeps[:m] + sweeps[m + 6:],
    "swapped": swapped,
    "reversed": reversed_order,
    "stamp_ahead": one_stamp_ahead,
    "clock_set": clock_set,
    "frozen": frozen,
    "doubled": doubled,
    "covered": edited(cover, 10),
    "nan": edited(nothing_but_nan),
    "empty": edited(lambda points, times: (points[:0], times[:0])),
    "half": edited(lambda points, times: (points[: len(points) // 2], times[: len(points) // 2])),
    "slow": slow,
    "stretches": stretches,
    "long_gaps": long_gaps,
}

WITHOUT_FAULT = {"none": as_used, "none_long": long_range, "none_whole": whole_drive}
# What a fault is made of; those that are not named, of the sweeps as used.
MADE_OF = {"slow": "none_whole", "stretches": "none_whole", "long_gaps": "none_long"}



def write_drive(drive, sweeps, folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "velodyne"))
    if drive.timed:
        os.makedirs(os.path.join(folder, "times_pt"))
    for k, entry in enumerate(sweeps):
        entry.write(folder, k)
    if all(s.stamp is not None for s in sweeps):
        with open(os.path.join(folder, "times.txt"), "w", encoding="ascii") as lines:
            lines.writelines(f"{s.stamp:.6f}\n" for s in sweeps)
    meta = os.path.join(drive.folder, "meta.json")
    if os.path.exists(meta):
        shutil.copy(meta, folder)
