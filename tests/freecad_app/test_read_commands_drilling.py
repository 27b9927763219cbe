# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling cycles of CAM operations: the moves they become, beside those of the same words as G-code; their faults."""

import re

import numpy as np
import Path
import pytest

from pkm_post.freecad_app.commands import read_commands
from pkm_post.model import EventKind, Kind
from pkm_post.reading.gcode import ReadOptions
from pkm_post.reading.gcode import read as read_gcode

FIRST = "G0 X0 Y0 Z20"
BOTTOM_UP = (Kind.RAPID, Kind.LINE, Kind.RAPID)


def read(*lines, **start):
    return read_commands([Path.Command(line) for line in lines], "part.FCStd", "Drilling", **start)


def program_of(*lines, **start):
    program, faults = read(*lines, **start)
    assert faults == ()
    return program


def test_a_hole_is_a_way_there_down_and_up_again():
    program = program_of(FIRST, "G81 X5 Y6 Z-2 R3 F2", "G80", "G0 X9")
    expected = [[0, 0, 20], [5, 6, 20], [5, 6, 3], [5, 6, -2], [5, 6, 20], [9, 6, 20]]
    np.testing.assert_array_equal(program.position, expected)
    np.testing.assert_array_equal(program.kind, [Kind.RAPID, Kind.RAPID, *BOTTOM_UP, Kind.RAPID])
    np.testing.assert_array_equal(program.feed, [np.nan, np.nan, np.nan, 2, np.nan, np.nan])
    np.testing.assert_array_equal(program.line, [1, 2, 2, 2, 2, 4])
    np.testing.assert_array_equal(program.tool_axis, [[0, 0, 1]] * 6)


def test_holes_near_each_other_stay_low_with_g99():
    program = program_of("G99", FIRST, "G81 X5 Z-2 R3 F2", "G81 X7 Z-2 R3")
    np.testing.assert_array_equal(program.position[:, 2], [20, 20, 3, -2, 3, 3, -2, 3])
    np.testing.assert_array_equal(program.position[:, 0], [0, 5, 5, 5, 5, 7, 7, 7])


def test_a_dwell_is_at_the_bottom():
    program = program_of(FIRST, "G82 X5 Z-2 R3 P0.5 F2")
    assert [(event.row, event.kind, event.value) for event in program.events] == [(4, EventKind.DWELL, 0.5)]
    assert program.position[3, 2] == -2


def test_a_hole_of_no_depth_still_dwells():
    program = program_of("G99", FIRST, "G82 X5 Z3 R3 P0.5 F2")
    assert [(event.row, event.value) for event in program.events] == [(3, 0.5)] and len(program) == 3


def test_the_first_place_may_be_that_of_the_hole():
    program = program_of("G0 Z20", "G81 X5 Y6 Z-2 R3 F2")
    np.testing.assert_array_equal(program.position, [[5, 6, 20], [5, 6, 3], [5, 6, -2], [5, 6, 20]])


def test_a_known_start_is_the_height_to_go_back_to():
    program = program_of("G81 X5 Z-2 R3 F2", start=(1.0, 2.0, 9.0))
    np.testing.assert_array_equal(program.position, [[5, 2, 9], [5, 2, 3], [5, 2, -2], [5, 2, 9]])


def as_gcode(lines):
    """The same words as G-code: F is mm/min there."""
    return "\n".join(["G21 G90", *(re.sub(r"F([\d.]+)", lambda f: f"F{60 * float(f[1]):g}", each) for each in lines)])


def random_holes(rng):
    """Cycles with their words in force or not, moves between them, and both ways to retract."""
    lines = [FIRST]
    words = {"G73": "Q", "G81": "", "G82": "P", "G83": "Q", "G85": "", "G89": "P"}
    for _ in range(12):
        code = str(rng.choice(list(words)))
        bottom, top = np.round(rng.uniform([-9, 1], [0, 30]), 2)
        more = {"Q": f" Q{rng.integers(1, 5)}", "P": f" P{rng.integers(0, 4) / 4}", "": ""}[words[code]]
        lines.append(str(rng.choice(["G98", "G99", "G80", "G0 Z25", "G1 X3 F7", "(nothing)"])))
        lines.append(f"{code} X{rng.integers(40)} Y{rng.integers(40)} Z{bottom} R{top}{more} F{rng.integers(1, 9)}")
        if rng.random() < 0.5:
            lines.append(f"{code} X{rng.integers(40)}")
    return lines


@pytest.mark.parametrize("seed", range(20))
def test_cycles_are_those_of_gcode(seed):
    lines = random_holes(np.random.default_rng(seed))
    ours = program_of(*lines)
    theirs, faults = read_gcode(as_gcode(lines) + "\nM2\n", "x.ngc", ReadOptions())
    assert not [fault for fault in faults if "error" in str(fault)]
    for name in ("kind", "position", "feed", "tool_axis"):
        np.testing.assert_allclose(getattr(ours, name), getattr(theirs, name), atol=1e-12, err_msg=name)
    np.testing.assert_array_equal(ours.line + 1, theirs.line)  # behind the line in front
    dwells = [[(each.row, each.value) for each in of.events if each.kind is EventKind.DWELL] for of in (ours, theirs)]
    assert dwells[0] == dwells[1] and len(ours) > 40


@pytest.mark.parametrize(
    ("lines", "code", "found"),
    [
        (["G81 X1 Y1 Z-1 F1"], "J122", "G81 without R"),
        (["G81 X1 Y1 R1 F1"], "J122", "G81 without a depth"),
        (["G83 X1 Y1 Z-1 R1 F1"], "J122", "G83 without Q"),
        (["G73 X1 Y1 Z-1 R1 Q-1 F1"], "J122", "G73 Q-1"),
        (["G82 X1 Y1 Z-1 R1 F1"], "J122", "G82 without P"),
        (["G81 X1 Y1 Z2 R1 F1"], "J122", "R 1 is below the bottom 2"),
        (["G83 Z-100 R1 Q0.001 F1"], "J122", "more than 10000 pecks"),
        (["G18", "G81 Z-1 R1 F1"], "J122", "after G18 or G19"),
        (["G1 X1 I0 J0 K1 F1", "G81 Z-1 R1 F1"], "J122", "other moves have I J K"),
        (["G81 Z-1 R1 F1", "G0 X3", "G81 X4"], "J122", "G81 without R"),
        (["G81 Z-1 R1 F1", "G82 X4 P1"], "J122", "G82 without R"),
        (["G81 Z-1 R1"], "J105", "no F"),
    ],
)
def test_faults_of_cycles(lines, code, found):
    program, faults = read(FIRST, *lines)
    assert program is None
    assert [(fault.code, fault.place.line) for fault in faults] == [(code, len(lines) + 1)]
    assert found in faults[0].found


def test_a_cycle_needs_to_know_where_it_begins():
    for lines in (["G81 X1 Y1 Z-1 R1 F1"], ["G0 Z9", "G81 X1 Z-1 R1 F1"], ["G0 X1 Y1", "G81 Z-1 R1 F1"]):
        program, faults = read(*lines)
        assert program is None
        assert [(fault.code, fault.found) for fault in faults] == [("J122", "G81: it is not known where the tool is")]


def test_each_cycle_fault_is_reported_once():
    _, faults = read(FIRST, *(f"G81 X{x} Z-1 F1" for x in range(5)))
    assert [(fault.code, fault.place.line, fault.found) for fault in faults] == [
        ("J122", 2, "G81 without R, and 4 more like it")
    ]
