# SPDX-License-Identifier: LGPL-2.1-or-later
"""G61, G61.1 and G64: what a program says of its corners, read and written."""

from dataclasses import replace

import numpy as np
import pytest
from programs import BALL, square_with_arc

from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.toolpath import with_chords
from pkm_post.writing.gcode import GcodeDialect, write

START = "T1 M6\nG0 X0 Y0 Z0\n"
MICRON = 1e-3


def taken(text, **options):
    program, faults = read(START + text, "part.ngc", ReadOptions(default_tool=BALL, **options))
    assert program is not None
    return program, [one.code for one in faults]


def test_exact_stop_exact_path_and_tolerance_hold_until_another_one():
    program, codes = taken("G61.1 G1 X1 F60\nX2\nG61 X3\nG64 P0.05\nX4\nX5\nG64 X6\n")
    assert codes == []
    assert program.exact_stop.tolist() == [False, True, True, False, False, False, False]
    assert program.exact_path.tolist() == [False, False, False, True, False, False, False]
    assert program.tip_tolerance.tolist() == [0, 0, 0, 0, 0.05, 0.05, 0]


def test_fanuc_stops_with_g61_and_for_one_block_with_g9_and_smooths_with_g61_1():
    program, _ = taken("G61 G1 X1 F60\nG61.1 X2\nG64 X3\nG9 X4\nX5\n", flavour="fanuc")
    assert not program.exact_path.any()
    assert program.exact_stop.tolist() == [False, True, True, False, True, False]
    assert [line.split()[0] for line in program.reading[1:]] == ["G61.1"]


def test_the_tolerance_has_the_unit_that_holds_where_it_is_said():
    program, _ = taken("G20 G64 P0.001\nG1 X1 F60\nG21 X1\n")
    np.testing.assert_allclose(program.tip_tolerance, [0, 0.0254, 0.0254], rtol=1e-12)


@pytest.mark.parametrize(
    "block",
    ["G64 P0", "G64 P-0.1", "G64 G4 P0.5", "G64 G2 X2 I0.5 P2", "G64 G82 X1 Z-1 R1 P0.5"],
    ids=["zero", "negative", "dwell", "turns of an arc", "cycle"],
)
def test_a_p_that_is_no_tolerance_is_reported(block):
    program, codes = taken(f"G1 X0 F60\nG64 P0.05 X1\n{block}\nG1 X3\n")
    assert codes == ["G417"]
    assert program.tip_tolerance[2] == 0.05
    assert program.tip_tolerance[-1] == 0


@pytest.mark.parametrize("cycle", ["G73 Q1", "G81", "G82 P0.5", "G83 Q1", "G85", "G86 P0.5", "G89 P0.5"])
def test_the_corners_of_a_cycle_are_not_rounded(cycle):
    """The hole is not entered askew, and as deep as programmed.

    rs274 prints SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH) before the moves of each cycle, and the mode of the program
    again after them.
    """
    program, codes = taken(f"S500 M3\nG64 P0.3\nG1 X1 F60\nG99 {cycle} X2 Z-3 R-1\nX3\nG80\nG1 X4\n")
    assert codes == []
    in_cycle = program.line - 2 == np.array([[4], [5]])
    assert in_cycle.sum(axis=1).min() >= 3
    np.testing.assert_array_equal(program.tip_tolerance[1:], np.where(in_cycle.any(axis=0), 0, 0.3)[1:])
    np.testing.assert_array_equal(program.exact_path, in_cycle.any(axis=0))


def test_q_alone_is_no_tolerance():
    program, codes = taken("G64 Q0.05\nG1 X1 F60\n")
    assert codes == []
    assert not program.tip_tolerance.any()


@pytest.mark.parametrize("form", GcodeDialect)
def test_written_as_rs274_means_it(form):
    given = square_with_arc()
    rows = np.arange(len(given))
    given = replace(given, exact_stop=rows == 1, exact_path=rows == 2, tip_tolerance=np.where(rows >= 3, 0.05, 0.0))
    text, _ = write(given, form)
    lines = [line for line in text.splitlines() if line.startswith("G6")]
    assert [line.split()[0] for line in lines] == ["G61.1", "G61", "G64"]
    assert lines[-1] == "G64 P0.050000"


def test_a_tolerance_below_the_last_decimal_is_not_lost():
    given = replace(square_with_arc(), tip_tolerance=np.full(len(square_with_arc()), 1e-9))
    text, _ = write(given, GcodeDialect.PLAIN, decimals=3)
    back, _ = read(text, "back.ngc", ReadOptions(default_tool=BALL))
    assert (back.tip_tolerance > 0).all()
    assert (back.tip_tolerance < 0.02 * MICRON).all()


def test_chords_have_the_corners_of_their_arc_and_stop_where_it_stops():
    given = square_with_arc()
    on_arc = given.line == 4
    given = replace(given, exact_stop=on_arc, exact_path=on_arc, tip_tolerance=np.where(on_arc, 0.05, 0.0))
    made = with_chords(given, np.flatnonzero(on_arc))
    chords = made.line == 4
    assert chords.sum() > 20
    np.testing.assert_array_equal(made.exact_path, chords)
    np.testing.assert_array_equal(made.tip_tolerance, np.where(chords, 0.05, 0.0))
    assert np.flatnonzero(made.exact_stop).tolist() == [np.flatnonzero(chords)[-1]]
