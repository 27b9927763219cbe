# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.halstreamer import (
    DECIMALS,
    PERIOD_MS,
    chord_error,
    lengths_at,
    measured,
    read_stream,
    sections,
    texts,
)

HALF_DIGIT = 0.5001 * 10.0**-DECIMALS


def moving(events=(), knots=40, seed=2):
    rng = np.random.default_rng(seed)
    speed = rng.normal(0, 30, (knots, 6))
    speed[[0, 15, -1, *(event.row for event in events)]] = 0.0
    time_ms = np.concatenate([[0], np.cumsum(rng.integers(1, 40, knots - 1))])
    length = 700 + np.cumsum(rng.normal(0, 0.3, (knots, 6)), axis=0)
    return StrutMotion(time_ms, length, speed, tuple(events))


def rows_of(motion):
    """The lengths that the tables of a motion state, before they are rounded."""
    return [lengths_at(motion, section.rows_ms(PERIOD_MS)) for section in sections(motion)]


def named(made):
    return [(f"table{number}", text) for number, text in enumerate(made, start=1)]


def test_the_rows_meet_every_knot_and_the_cubic_between():
    motion = moving()
    (rows,) = rows_of(motion)
    assert len(rows) == motion.time_ms[-1] + 1
    assert np.array_equal(rows[motion.time_ms[:-1]], motion.length[:-1])
    np.testing.assert_allclose(rows[-1], motion.length[-1], rtol=0, atol=1e-12)
    # p = p0 + v0 t + c2 t^2 + c3 t^3 as PMAC documents its PVT mode, for strut 1 in the longest interval
    knot = int(np.argmax(np.diff(motion.time_ms)))
    span = (motion.time_ms[knot + 1] - motion.time_ms[knot]) / 1000
    p0, p1 = motion.length[knot : knot + 2, 0]
    v0, v1 = motion.speed[knot : knot + 2, 0]
    t, way = 0.007, p1 - p0
    by_hand = p0 + v0 * t + (3 * way - (2 * v0 + v1) * span) / span**2 * t**2
    by_hand += ((v0 + v1) * span - 2 * way) / span**3 * t**3
    assert rows[motion.time_ms[knot] + 7, 0] == pytest.approx(by_hand, abs=1e-9)


def test_what_was_written_reads_back_to_the_printed_decimals():
    motion = moving([Event(0, EventKind.TOOL_CHANGE, 1.0), Event(15, EventKind.DWELL, 0.0125)])
    made, planned = texts(motion, ["job Säule"]), rows_of(motion)
    assert len(made) == len(planned) == 1
    read, faults = read_stream(made[0], "t")
    assert faults == ()
    assert read.period_ms == 1
    np.testing.assert_allclose(read.length, planned[0], rtol=0, atol=HALF_DIGIT)


def test_every_line_is_one_that_halstreamer_takes():
    # halstreamer(1): six floats parted by white space for cfg=ffffff; lines that begin with # are skipped
    for line in texts(moving(), ["Säule"])[0].splitlines():
        assert line.isascii()
        assert line.startswith("#") or [float(word) for word in line.split(" ")][5:]
        assert line.startswith("#") or len(line.split(" ")) == 6


def test_a_dwell_is_rows_that_stay_the_same():
    still, dwelling = moving(), moving([Event(15, EventKind.DWELL, 0.0125)])
    (without,), (rows,) = rows_of(still), rows_of(dwelling)
    knot = still.time_ms[15]
    # 12.5 ms: the rows behind it are half a millisecond off the clock of the motion
    assert len(rows) == len(without) + 13
    assert np.array_equal(rows[: knot + 1], without[: knot + 1])
    assert np.array_equal(rows[knot : knot + 13], np.tile(still.length[15], (13, 1)))
    halves = still.time_ms[0] + np.arange(knot, still.time_ms[-1]) + 0.5
    np.testing.assert_allclose(rows[knot + 13 : -1], lengths_at(still, halves), rtol=0, atol=1e-9)
    np.testing.assert_allclose(rows[-1], still.length[-1], rtol=0, atol=1e-12)


def test_a_table_ends_where_something_else_than_a_dwell_happens():
    events = [
        Event(0, EventKind.TOOL_CHANGE, 1.0),
        Event(0, EventKind.SPINDLE, 1200.0),
        Event(15, EventKind.DWELL, 0.002),
        Event(15, EventKind.COOLANT, 1.0),
        Event(15, EventKind.DWELL, 0.003),
        Event(39, EventKind.SPINDLE, 0.0),
    ]
    motion = moving(events)
    first, second = rows_of(motion)
    knot = int(motion.time_ms[15])
    assert len(first) == knot + 1 + 2
    assert len(second) == motion.time_ms[-1] - knot + 1 + 3
    assert np.array_equal(first[-1], second[0])
    one, two = texts(motion, [])
    assert "# part 1 of 2" in one and "# before: tool_change 1, spindle 1200\n" in one and "after" not in one
    assert "# part 2 of 2" in two and "# before: coolant 1\n" in two and two.endswith("# after: spindle 0\n")


def test_a_motion_of_one_knot_is_one_row():
    motion = StrutMotion(np.array([0]), np.full((1, 6), 500.0), np.zeros((1, 6)), ())
    assert rows_of(motion)[0].shape == (1, 6)
    assert chord_error(motion) == 0.0
    assert measured(named(texts(motion, [])), motion)[1] == ()


def test_no_straight_line_between_rows_is_farther_from_the_cubic_than_the_bound():
    # 20 mm to and fro at 1.5 Hz, knots 20 ms apart: the accelerations of a machine
    time = np.arange(0, 1001, 20) / 1000
    turn = 3 * np.pi * time[:, None] + np.arange(6)
    motion = StrutMotion(np.arange(0, 1001, 20), 700 + 20 * np.sin(turn), 60 * np.pi * np.cos(turn), ())
    (rows,) = rows_of(motion)
    times = np.arange(len(rows) - 1) * float(PERIOD_MS)
    way = np.diff(rows, axis=0)
    off = [
        np.abs(rows[:-1] + share * way - lengths_at(motion, times + share * PERIOD_MS)).max()
        for share in np.linspace(0, 1, 21)
    ]
    bound = chord_error(motion)
    assert 0.98 * bound < max(off) <= bound * (1 + 1e-6)
    # by hand: T^2 / 8 times the acceleration 20 (3 pi)^2 of the sine; the cubics swing a little about it
    assert bound == pytest.approx(1e-6 / 8 * 20 * (3 * np.pi) ** 2, rel=0.005)


def test_the_distance_from_the_cubics_is_measured_from_the_text():
    motion = moving([Event(15, EventKind.DWELL, 0.0125)])
    reported, faults = measured(named(texts(motion, ["x"])), motion)
    assert faults == ()
    assert reported.endswith(" mm from the cubics")
    worst = float(reported.split(" mm")[0].split()[-1])
    assert 0 < worst <= chord_error(motion) + HALF_DIGIT


def test_a_table_that_is_not_that_of_the_motion_is_found():
    motion = moving()
    (text,) = texts(motion, [])
    first = text.split("period 1 ms\n")[1].split("\n")[3]
    changed = first.replace(first.split()[2], f"{float(first.split()[2]) + 0.01:.6f}")
    for wrong in (text.replace(first, changed), text.replace(first + "\n", "")):
        assert [fault.code for fault in measured([("t", wrong)], motion)[1]] == ["C107"]
    assert [fault.code for fault in measured([("t", text), ("u", text)], motion)[1]] == ["C107"]
    other = replace(motion, length=motion.length + 0.01)
    assert [fault.code for fault in measured([("t", text)], other)[1]] == ["C107"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("# period 1 ms\n", ""),
        ("# period 1 ms\n", "# period 0 ms\n"),
        pytest.param("# period 1 ms\n", f"# period {'9' * 5000} ms\n", id="endless period"),
        pytest.param("# period 1 ms\n", f"# period 1 ms\n{'9' * 400}.0 2.0 3.0 4.0 5.0 6.0\n", id="endless length"),
        ("# period 1 ms\n", "# period 1 ms\n# period 1 ms\n"),
        ("# period 1 ms\n", "# period 1 ms\n\n"),
        ("# period 1 ms\n", "# period 1 ms\n1.0 2.0 3.0 4.0 5.0\n"),
        ("# period 1 ms\n", "# period 1 ms\n1.0 2.0 3.0 4.0 5.0 6.0 7.0\n"),
        ("# period 1 ms\n", "# period 1 ms\n1.0 2.0 3.0 4.0 5.0 6e0\n"),
        ("# period 1 ms\n", "# period 1 ms\n1.0 2.0 3.0 4.0 5.0 nan\n"),
        ("# period 1 ms\n", "# period 1 ms\n1.0  2.0 3.0 4.0 5.0 6.0\n"),
    ],
)
def test_a_malformed_table_is_reported(old, new):
    (text,) = texts(moving(), [])
    assert old in text
    read, faults = read_stream(text.replace(old, new), "t")
    assert read is None
    assert [fault.code for fault in faults] == ["C106"]


def test_a_table_cut_off_within_a_row_is_reported_with_its_line():
    (text,) = texts(moving(), [])
    faults = read_stream(text[:-2], "t")[1]
    assert [(fault.code, fault.place.line) for fault in faults] == [("C106", text.count("\n"))]
