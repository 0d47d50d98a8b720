"""Which arrays are taken, and what is said of others."""

import numpy as np
import pytest

import rilo


REFUSED_POINTS = [
    (np.zeros((5, 2), np.float32), r"points: got shape \(5, 2\), float32; expected shape \(N, 3\) or \(N, 4\)"),
    (np.zeros((3, 100)), r"got shape \(3, 100\), float64; .*Transpose it: points.T"),
    (np.zeros((5, 6), np.float32), r"got shape \(5, 6\).*points\[:, :3\]"),
    (np.zeros((5, 3), np.int16), r"got shape \(5, 3\), int16; .*astype"),
    (np.zeros((5, 3), ">f4"), "got shape .*>f4"),
    (np.zeros(5, [("x", "f4"), ("y", "f4"), ("z", "f4")]), "Of fields: np.stack"),
    (np.zeros(12, np.float32), r"got shape \(12,\)"),
    ("points", "points: got"),
    (None, "points: got"),
]


@pytest.mark.parametrize("points, message", REFUSED_POINTS)
def test_other_points_are_refused_with_what_came(points, message):
    odometry = rilo.Odometry()
    for call in odometry.register, odometry.register_frame:
        with pytest.raises(ValueError, match=message):
            call(points)
    assert len(odometry) == 0


def test_bad_columns_are_refused(drive):
    points, times, _, _ = drive[0]
    odometry = rilo.Odometry()
    with pytest.raises(ValueError, match=f"times_s: 3 values for {len(points)} points"):
        odometry.register(points, times[:3])
    with pytest.raises(ValueError, match="times_s: got .*int64; expected float32 or float64, seconds"):
        odometry.register(points, np.zeros(len(points), np.int64))
    with pytest.raises(ValueError, match=r"times_s: got shape \(\d+, 1\)"):
        odometry.register(points, times[:, None])
    with pytest.raises(ValueError, match="rings: 2 values"):
        odometry.register(points, times, 0, np.zeros(2, np.uint16))
    with pytest.raises(ValueError, match="rings: got -1 at index 0"):
        odometry.register(points, times, 0, np.full(len(points), -1))
    with pytest.raises(ValueError, match="rings: got .*float64"):
        odometry.register(points, times, 0, np.zeros(len(points)))
    with pytest.raises(ValueError, match=r"truth: got shape \(4, 4\), float64; expected poses of shape \(N, 4, 4\)"):
        rilo.evaluate(np.eye(4), np.eye(4))
    assert len(odometry) == 0
    assert odometry.register(np.zeros((0, 3), np.float32)).status == "empty"
    assert odometry.register(np.full((100, 3), np.nan, np.float32), stamp_ns=1).status == "empty"


def test_times_that_are_no_seconds_of_a_sweep_are_refused(drive):
    """Taken for seconds, they would keep the odometry from ever getting under way."""
    points, times, *_ = drive[0]
    odometry = rilo.Odometry()
    epoch = 1_700_000_000 + times.astype(np.float64)
    wild = times.copy()
    wild[7] = 1e9
    for bad in (times * 1e3, times * 1e6, times.astype(np.float64) * 1e9, epoch, -epoch, wild):
        with pytest.raises(ValueError, match=r"times_s: got \S+ at index \d+; expected seconds from stamp_ns, at most 2.5.*register_frame"):
            odometry.register(points, bad)
    assert len(odometry) == 0
    unmeasured = points.copy()
    unmeasured[7] = np.nan
    assert odometry.register(unmeasured, wild).status == "initialising"
    unmeasured[7] = 0
    assert odometry.register(unmeasured, wild).status != "lost"


def test_stamps_are_whole_numbers(drive):
    points, times, *_ = drive[0]
    for stamp in (-(10**9), np.int32(5), np.uint64(7), np.array(8)):
        odometry = rilo.Odometry()
        assert odometry.register(points, None, stamp).stamp_ns == stamp
        assert rilo.Odometry().register_frame(points, None, stamp).stamp_ns == stamp
    odometry = rilo.Odometry()
    for call in odometry.register, odometry.register_frame:
        for stamp in (1.5, np.float64(1), "0"):
            with pytest.raises(TypeError, match=r"stamp_ns: got .* of type \w+; expected a whole number of ns, or None"):
                call(points, times, stamp)
        for stamp in (2**63, np.uint64(2**63), -(2**64)):
            with pytest.raises(ValueError, match="stamp_ns: got -?[0-9]+; expected ns that fit 64 bits"):
                call(points, times, stamp)
    assert len(odometry) == 0


def test_numbers_beyond_int64_are_refused(drive):
    points, times, *_ = drive[0]
    huge = np.full(len(points), 2**64 - 1, np.uint64)
    told = "got 18446744073709551615 at index 0; expected numbers below 2"
    with pytest.raises(ValueError, match=f"timestamps: {told}"):
        rilo.Odometry().register_frame(points, huge)
    with pytest.raises(ValueError, match=f"rings: {told}"):
        rilo.Odometry().register(points, times, 0, huge)


def test_layouts_types_and_columns_give_the_same_bits(drive, run):
    expected = run[0].trajectory[:3]
    wide = [np.hstack([points, np.full((len(points), 1), 7, np.float32)]) for points, *_ in drive[:3]]
    layouts = {
        "N x 4": lambda i: wide[i],
        "float64": lambda i: drive[i][0].astype(np.float64),
        "N x 4 float64": lambda i: wide[i].astype(np.float64),
        "columns together": lambda i: np.asfortranarray(drive[i][0]),
        "every second row": lambda i: np.repeat(drive[i][0], 2, axis=0)[::2],
        "a slice of columns": lambda i: wide[i][:, :3],
        "lists": lambda i: drive[i][0].tolist(),
    }
    for name, layout in layouts.items():
        odometry = rilo.Odometry()
        for i in range(3):
            times = drive[i][1].astype(np.float64 if "float64" in name else np.float32)
            odometry.register(layout(i), times, drive[i][2])
        assert np.array_equal(odometry.trajectory, expected), name


def test_why_something_is_no_array_is_told():
    class OnAnotherDevice:
        def __array__(self, *_, **__):
            raise TypeError("copy the tensor to host memory first")

    with pytest.raises(ValueError, match="points: got an object of type OnAnotherDevice; .* copy the tensor to host"):
        rilo.Odometry().register(OnAnotherDevice())
    with pytest.raises(ValueError, match="points: got an object of type list; expected a numpy array"):
        rilo.Odometry().register([[1, 2, 3], [1, 2]])


def test_masked_elements_are_no_numbers(drive):
    points, times, stamp, _ = drive[0]
    odometry = rilo.Odometry()
    masked = np.ma.masked_greater(points, 20)
    with pytest.raises(ValueError, match=r"points: got shape .*; expected no masked elements. .*points.filled\(np.nan\)"):
        odometry.register(masked, times, stamp)
    with pytest.raises(ValueError, match="times_s: got .*; expected no masked elements"):
        odometry.register(points, np.ma.masked_less(times, 0.01), stamp)
    assert len(odometry) == 0
    odometry.register(masked.filled(np.nan), np.ma.masked_array(times), stamp)  # none is
    assert len(odometry) == 1


def test_rings_of_any_integer_type_are_the_same(drive):
    points, times, stamp, _ = drive[0]
    rings = np.arange(len(points)) % 16
    maps = []
    for dtype in np.uint16, np.int64, np.uint8:
        odometry = rilo.Odometry()
        odometry.register(points, times, stamp, rings.astype(dtype))
        maps.append(odometry.local_map())
    assert np.array_equal(maps[0], maps[1]) and np.array_equal(maps[0], maps[2])


def test_register_frame_takes_the_drivers_timestamps(drive, run):
    expected = run[0].trajectory[:4]
    earliest = [times[np.linalg.norm(points, axis=1) > 0].min() for points, times, *_ in drive]
    assert min(earliest) >= 0
    clock = 1_700_000_000

    def poses(stamps_of_points, **options):
        odometry = rilo.Odometry()
        for points, times, stamp, _ in drive[:4]:
            odometry.register_frame(points, stamps_of_points(times, stamp), **options)
        return odometry

    relative = poses(lambda times, stamp: times)  # 0.1 s apart, as the drive is
    assert np.array_equal(relative.trajectory, expected)
    assert np.array_equal(relative.stamps_ns, run[0].stamps_ns[:4])
    for name, absolute in {
        "float64 s": lambda times, stamp: clock + stamp * 1e-9 + times.astype(np.float64),
        "int64 ns": lambda times, stamp: clock * 10**9 + stamp + np.round(times.astype(np.float64) * 1e9).astype(np.int64),
        "uint64 us": lambda times, stamp: (clock * 10**6 + stamp // 1000 + times.astype(np.float64) * 1e6).astype(np.uint64),
    }.items():
        odometry = poses(absolute)
        assert np.abs(odometry.trajectory - expected).max() < 1e-3, name
        assert np.abs(odometry.stamps_ns - run[0].stamps_ns[:4] - clock * 10**9).max() < 2_000_000, name
    fractions = poses(lambda times, stamp: times / np.float32(0.1), point_time_unit="fraction")
    assert np.abs(fractions.trajectory - expected).max() < 1e-4


@pytest.mark.parametrize("began_s", [0.0, 0.4, 1.7, 2.3])
@pytest.mark.parametrize("stamped_s", [None, 0.0, 0.1])
def test_register_frame_takes_timestamps_of_a_clock_that_has_just_begun(drive, run, began_s, stamped_s):
    """As simulated ones: the first sweep alone does not tell its times from those since the start of a sweep."""
    odometry = rilo.Odometry()
    for points, times, stamp, _ in drive:
        of_clock = began_s + stamp * 1e-9 + times.astype(np.float64)
        known = None if stamped_s is None else stamp + round((began_s + stamped_s) * 1e9)
        odometry.register_frame(points, of_clock, known)
    begins_ns = round((began_s + (stamped_s or 0)) * 1e9)
    assert np.abs(odometry.stamps_ns - run[0].stamps_ns - begins_ns).max() < 1_000
    assert np.abs(odometry.trajectory - run[0].trajectory).max() < 1e-3


def test_register_frame_takes_the_parts_of_a_sweep(drive):
    """They go on where the one before ended, too, but their stamp stays."""
    points, times, _, _ = drive[0]
    frames, sweeps = rilo.Odometry(), rilo.Odometry()
    for part in times < 0.05, times >= 0.05:
        frames.register_frame(points[part], times[part], 5_000_000_000)
        sweeps.register(points[part], times[part], 5_000_000_000)
    assert np.array_equal(frames.stamps_ns, sweeps.stamps_ns)
    assert np.array_equal(frames.trajectory, sweeps.trajectory)


def test_register_frame_without_timestamps_is_register(drive):
    one, other = rilo.Odometry(), rilo.Odometry()
    for i, (points, *_) in enumerate(drive[:3]):
        one.register_frame(points)
        other.register(points, None, i * 100_000_000)
    assert np.array_equal(one.trajectory, other.trajectory) and np.array_equal(one.stamps_ns, other.stamps_ns)
    one.reset()
    assert one.register_frame(drive[0][0]).stamp_ns == 0


def test_register_frame_refuses_what_cannot_be_told(drive):
    points, times, _, _ = drive[0]
    odometry = rilo.Odometry()
    with pytest.raises(ValueError, match="timestamps: .*either seconds or fractions.*Give point_time_unit"):
        odometry.register_frame(points, times / np.float32(0.1))
    with pytest.raises(ValueError, match=r"timestamps: got shape \(3,\), float32; expected shape \(\d+,\)"):
        odometry.register_frame(points, times[:3])
    with pytest.raises(ValueError, match="point_time_unit: got 'minutes'; expected infer, s, ms"):
        odometry.register_frame(points, times, point_time_unit="minutes")
    assert len(odometry) == 0


def test_points_are_used_in_place_and_kept(drive):
    points = drive[0][0].copy()
    points.flags.writeable = False
    odometry = rilo.Odometry()
    odometry.register(points)
    odometry.register_frame(points, drive[0][1])
    assert np.array_equal(points, drive[0][0])
