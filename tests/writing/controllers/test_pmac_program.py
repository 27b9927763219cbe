# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.pmac import program_text

JOB = """\
; job
CLOSE
DELETE GATHER
OPEN PROG 10
CLEAR
ABS
FRAX(A,B,C,U,V,W)
LINEAR
TA500 TS0 F10
A512.000000 B513.000000 C514.000000 U515.000000 V516.000000 W517.000000
DWELL0
T3 M6
S1200 M3
M8
PVT20
A512.062500:3.1250 B513.062500:3.1250 C514.062500:3.1250 U515.062500:3.1250 V516.062500:3.1250 W517.062500:3.1250
A512.125000:0.0000 B513.125000:0.0000 C514.125000:0.0000 U515.125000:0.0000 V516.125000:0.0000 W517.125000:0.0000
DWELL0
M7
DWELL500
DWELL0
M0
M1
S850.5 M4
PVT1000
A511.500000:0.0000 B512.500000:0.0000 C513.500000:0.0000 U514.500000:0.0000 V515.500000:0.0000 W516.500000:0.0000
DWELL0
M5
M9
LINEAR
CLOSE
"""


def _at_rest(time_ms, events=()):
    knots = len(time_ms)
    return StrutMotion(np.array(time_ms), np.full((knots, 6), 500.0), np.zeros((knots, 6)), events)


def _body(text):
    """The lines after the approach, with every move as 'move'."""
    return re.sub(r"A.*:.*", "move", text).split("DWELL0\n", 1)[1].split("\n")[:-1]


def test_a_job_with_every_kind_of_event(job, settings):
    assert program_text(job, settings, ["job"]) == JOB


def test_the_time_is_reported_where_it_changes_and_after_every_interruption(settings):
    dwell = Event(2, EventKind.DWELL, 1.0)
    body = _body(program_text(_at_rest([0, 20, 40, 60, 65, 70], (dwell,)), settings, []))
    assert body == [
        *("PVT20", "move", "move", "DWELL0", "DWELL1000"),
        *("PVT20", "move", "PVT5", "move", "move", "DWELL0", "LINEAR", "CLOSE"),
    ]


def test_a_motion_of_one_knot_is_an_approach(settings):
    assert _body(program_text(_at_rest([0]), settings, [])) == ["LINEAR", "CLOSE"]


def test_no_number_is_minus_zero(settings):
    speed = np.zeros((3, 6))
    speed[1] = [-0.00004, -0.0, -0.00005, -1e-300, -0.00006, -0.00014]
    motion = StrutMotion(np.array([0, 20, 40]), np.full((3, 6), -0.0000001), speed, ())
    text = program_text(motion, settings, [])
    assert not re.search(r"-0\.0+(?![0-9])", text)
    assert [word.split(":")[1] for word in text.split("PVT20\n")[1].split("\n")[0].split()] == [
        *("0.0000", "0.0000", "0.0000", "0.0000", "-0.0001", "-0.0001"),
    ]


def test_every_number_has_digits_on_both_sides_of_the_point_and_no_exponent(settings):
    # the manuals show plain decimals only; a lexer of PMAC programs by others (dls_pmacanalyse 3.0.0) rejects .5 and 5.
    rng = np.random.default_rng(1)
    speed = rng.normal(size=(500, 6)) * 10.0 ** rng.integers(-12, 5, (500, 6))
    speed[[0, -1]] = 0.0
    text = program_text(StrutMotion(np.arange(500), speed * 3, speed, ()), settings, [])
    moves = re.findall(r"^A.*:.*$", text, re.MULTILINE)
    assert len(moves) == 499
    word = r"[ABCUVW]-?[0-9]+\.[0-9]{6}:-?[0-9]+\.[0-9]{4}"
    assert all(re.fullmatch(" ".join([word] * 6), move) for move in moves)


def test_the_longest_plausible_line_is_within_the_limit(settings):
    # 159 characters: what the dual-ported RAM takes of a line (PMAC Dual-Ported RAM manual, p. 29)
    motion = StrutMotion(np.array([0, 20, 40]), np.full((3, 6), -9999.999999), np.zeros((3, 6)), ())
    motion = replace(motion, speed=np.array([0.0, -9999.9999, 0.0])[:, None] * np.ones(6))
    assert max(map(len, program_text(motion, settings, ["x" * 500]).splitlines())) <= 159


def test_the_settings_shape_the_program(job, settings):
    other = replace(
        settings, letters=tuple("UVWXYZ"), program=7, length_decimals=3, speed_decimals=2, approach_speed=2.5
    )
    text = program_text(job, other, [])
    assert "OPEN PROG 7\n" in text
    assert "FRAX(U,V,W,X,Y,Z)\n" in text
    assert "TA500 TS0 F2.5\nU512.000 V513.000 W514.000 X515.000 Y516.000 Z517.000\n" in text
    assert "PVT20\nU512.062:3.12 " in text


@pytest.mark.parametrize("time_ms", [[], [5, 25], [0, 20, 20], [0, 20, 10], [0, 4096]])
def test_times_that_the_controller_cannot_keep_are_refused(settings, time_ms):
    with pytest.raises(ValueError, match="expected (knots from 0 ms on|intervals of 1 to 4095 ms)"):
        program_text(_at_rest(time_ms), settings, [])


def test_the_longest_interval_is_accepted(settings):
    # 0 to 4095.9998 ms, whole ms with I42 = 1 (Turbo PMAC Software Reference, p. 463; User Manual, p. 292)
    assert "PVT4095\n" in program_text(_at_rest([0, 4095]), settings, [])


@pytest.mark.parametrize("knot", [0, 2, 4])
def test_a_motion_that_does_not_rest_at_an_end_or_an_event_is_refused(settings, knot):
    motion = _at_rest([0, 20, 40, 60, 80], (Event(2, EventKind.DWELL, 1.0),))
    speed = np.zeros((5, 6))
    speed[knot, 3] = 0.0001
    with pytest.raises(ValueError, match=f"expected rest at knot {knot}"):
        program_text(replace(motion, speed=speed), settings, [])


@pytest.mark.parametrize("column", ["length", "speed"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_number_that_is_not_finite_is_refused(settings, column, value):
    motion = _at_rest([0, 20, 40])
    values = getattr(motion, column).copy()
    values[1, 2] = value
    with pytest.raises(ValueError, match="expected finite lengths and speeds"):
        program_text(replace(motion, **{column: values}), settings, [])


@pytest.mark.parametrize("rows", [(-1,), (3,), (2, 1)])
def test_events_out_of_order_or_beyond_the_motion_are_refused(settings, rows):
    events = tuple(Event(row, EventKind.STOP, 0) for row in rows)
    with pytest.raises(ValueError, match="expected rows in order from 0 to 2"):
        program_text(_at_rest([0, 20, 40], events), settings, [])


def test_an_event_without_code_is_refused(settings):
    with pytest.raises(ValueError, match="expected one with a code"):
        program_text(_at_rest([0, 20], (Event(0, EventKind.COOLANT, 9),)), settings, [])


def _line_by_line(motion, settings):
    """What stands behind the approach, made of one line after the other."""
    stops = {0, len(motion) - 1} | {event.row for event in motion.events}
    known = None
    for knot in range(len(motion)):
        if knot:
            interval = motion.time_ms[knot] - motion.time_ms[knot - 1]
            if interval != known:
                yield f"PVT{interval}"
            known = interval
            pairs = zip(
                settings.letters,
                np.round(motion.length[knot], settings.length_decimals) + 0.0,
                np.round(motion.speed[knot], settings.speed_decimals) + 0.0,
                strict=True,
            )
            yield " ".join(
                f"{letter}{length:.{settings.length_decimals}f}:{speed:.{settings.speed_decimals}f}"
                for letter, length, speed in pairs
            )
        if knot in stops:
            yield "DWELL0"
            known = None
        yield from ("DWELL500" for event in motion.events if event.row == knot)


@pytest.mark.slow
@pytest.mark.parametrize("decimals", [(6, 4), (1, 9), (9, 1)])
@pytest.mark.parametrize("farthest", [1500.0, 1e12], ids=["a machine", "beyond what is printed at once"])
def test_a_long_program_is_that_of_one_line_after_the_other(settings, decimals, farthest):
    rng = np.random.default_rng(11)
    knots = 8200  # three chunks of the writer, with stops where they meet
    rows = [0, 0, 1, 2, 700, 4095, 4096, 4097, 4098, 8191, 8192, 8193, 8198, 8199, 8199]
    length, speed = rng.uniform(-farthest, farthest, (2, knots, 6)) * 10.0 ** rng.integers(-9, 1, (2, knots, 6))
    speed[[0, -1, *rows]] = 0.0
    time_ms = np.cumsum([0, *rng.choice([1, 20, 20, 20, 4095], knots - 1)])
    motion = StrutMotion(time_ms, length, speed, tuple(Event(row, EventKind.DWELL, 0.5) for row in rows))
    other = replace(settings, length_decimals=decimals[0], speed_decimals=decimals[1])
    text = program_text(motion, other, []).split("DWELL0\n", 1)[1]
    assert text.splitlines()[:-2] == list(_line_by_line(motion, other))[1:]
