# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polar coordinates: @ and ^ of LinuxCNC, compared with what rs274 2.9 printed, and G16 of Fanuc's controls."""

import numpy as np
import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)
PRINTED = 5e-5
"""mm: rs274 prints four decimals."""


def taken(text, **options):
    return read(text, "part.ngc", ReadOptions(default_tool=ANY, **options))


def ends(text, **options):
    program, faults = taken(text, **options)
    assert program is not None, [str(fault) for fault in faults]
    rows = np.append(0, np.flatnonzero(np.any(np.diff(program.position, axis=0), axis=1)) + 1)
    return program.position[rows]


# What rs274 of linuxcnc-uspace 2.9.0 prints of these programs.
MOVES = """G21 F100
G0 X10 Y0 Z0
G1 @20 ^45
^90
@5
G91 @5 ^30
G90 G3 @20 ^90 R15
"""
MOVED = [[10, 0, 0], [14.1421, 14.1421, 0], [0, 20, 0], [0, 5, 0], [-5, 8.6603, 0], [0, 20, 0]]
HOLES = "G21 F100\nG0 X10 Y5 Z0\nG17 G81 @20 ^30 Z-1 R1\n^60\nG80\nG20\nG1 @1 ^0\n"
DRILLED = [
    [10, 5, 0], [10, 5, 1], [17.3205, 10, 1], [17.3205, 10, -1], [17.3205, 10, 1], [10, 17.3205, 1], [10, 17.3205, -1],
    [10, 17.3205, 1], [25.4, 0, 1],
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), [(MOVES, MOVED), (HOLES, DRILLED)], ids=["moves", "holes"])
def test_distance_and_angle_are_those_of_rs274(text, expected):
    np.testing.assert_allclose(ends(text), expected, rtol=0, atol=PRINTED)


def test_repeated_holes_go_round_as_those_of_rs274():
    # rs274: six times STRAIGHT_FEED down, at these X and Y; then X and Y on from there by 1 in radius
    text = "G21 F100\nG0 X15 Y0 Z3\nG91 G81 ^60 R-2 Z-1 L6\n@1 L2\nG80\n"
    bottoms = ends(text)
    around = [[7.5, 12.9904], [-7.5, 12.9904], [-15, 0], [-7.5, -12.9904], [7.5, -12.9904], [15, 0], [16, 0], [17, 0]]
    np.testing.assert_allclose(bottoms[bottoms[:, 2] == 0, :2], around, rtol=0, atol=PRINTED)


@pytest.mark.parametrize("word", ["@1", "^30"])
def test_machine_coordinates_have_no_polar_words(word):
    # rs274: "Cannot use polar coordinates with G53"
    program, faults = taken(f"G21 F100\nG0 X15 Y0 Z3\nG53 G0 Z4 {word}\nM2\n", machine_zero=(0, 0, 0))
    assert program is None and [(fault.code, fault.place.line) for fault in faults] == [("G407", 3)]


def test_the_centre_of_a_polar_arc_is_that_of_rs274():
    program, _ = taken(MOVES)
    np.testing.assert_allclose(program.arc_centre[-1], [-14.9992, 19.8413, 0], rtol=0, atol=PRINTED)


@pytest.mark.parametrize(
    ("block", "code"),
    [("G91 G0 @5 ^30", "G406"), ("G0 @1 X1", "G407"), ("G0 ^1", "G406"), ("F1 @2", "G406")],
)
def test_what_rs274_refuses_of_them_is_a_fault(block, code):
    program, faults = taken(f"G21 F100\nG0 X0 Y0 Z0\n{block}\n")
    assert (program, [fault.code for fault in faults]) == (None, [code])


def test_a_word_alone_needs_the_place_of_the_tool():
    assert [fault.code for fault in taken("G0 @5\nX0 Y0 Z0\n")[1]] == ["G416"]


def test_g16_takes_the_words_of_the_plane_for_radius_and_angle():
    text = "G21 F100\nG0 X1 Y1 Z5\nG16\nX50 Y30\nY150\nX20\n{}G15\nX1 Y2\n"
    turn = np.radians([30, 150, 150])
    circle = np.column_stack([np.array([50, 50, 20]) * np.cos(turn), np.array([50, 50, 20]) * np.sin(turn), [5] * 3])
    found = ends(text.format(""), flavour="fanuc")
    np.testing.assert_allclose(found, [[1, 1, 5], *circle, [1, 2, 5]], atol=1e-9)
    holes = ends(text.format("G99 G81 X50 Y270 Z-3 R2\nG80\n"), flavour="fanuc")
    np.testing.assert_allclose(holes[-3:-1], [[0, -50, -3], [0, -50, 2]], atol=1e-9)


def test_g16_in_another_plane_and_in_inches():
    found = ends("G20 G19 F10\nG0 X0 Y1 Z0\nG16 Y2 Z90\n", flavour="fanuc")
    np.testing.assert_allclose(found[-1], [0, 0, 50.8], atol=1e-9)


@pytest.mark.parametrize("plane", ["G17 X Y Z", "G18 Z X Y", "G19 Y Z X"])
def test_an_angle_alone_after_g16_and_g91_turns_on_from_the_tool(plane):
    """Fanuc and [NCT], polar coordinates: the radius stays, and the angle adds to that of the tool."""
    select, radius, angle, across = plane.split()
    start = f"G21 {select} G90 F100\nG0 {across}10 {radius}50 {angle}0\n"
    moves = ends(f"{start}G16 {angle}30\nG91 {angle}120\nG1 {angle}-30\nG15\n", flavour="fanuc")[-3:]
    axes = ["XYZ".index(letter) for letter in (radius, angle)]
    np.testing.assert_allclose(np.array(moves)[:, axes], on_circle(50, [30, 150, 120]), atol=1e-9)


def test_holes_repeated_by_angle_after_g16_and_g91_are_on_a_circle():
    text = "G21 G90 F100\nG0 Z10 X50 Y0\nG16 G91 G99 G81 Y40 R-8 Z-5 K3\nG80\nG15\n"
    found = np.array(ends(text, flavour="fanuc"))
    np.testing.assert_allclose(found[found[:, 2] < 0][:, :2], on_circle(50, [40, 80, 120]), atol=1e-9)


def on_circle(radius, degrees):
    return radius * np.column_stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


def test_g16_with_g91_counts_from_the_tool_and_is_refused():
    faults = taken("G21\nG0 X1. Y1. Z5.\nG16 G91\nX5. Y30.\n", flavour="fanuc")[1]
    assert [(fault.code, fault.place.line) for fault in faults] == [("G440", 4)]
