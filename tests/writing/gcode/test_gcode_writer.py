# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs written as G-code and read back, in every form."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from programs import BALL, cone, program, random_job, square_with_arc

from pkm_post.geometry import angle_between, norm
from pkm_post.machine import platform_rotation
from pkm_post.model import Event, EventKind, Kind, Tool
from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.toolpath import CHORD_ERROR
from pkm_post.writing.gcode import GcodeDialect, write
from pkm_post.writing.gcode.tool_axes import MAX_AXIS_DEVIATION, NOTATIONS, POLE, axis_deviation

READER_WORDS = {
    GcodeDialect.VECTOR: "vector",
    GcodeDialect.AC: "AC",
    GcodeDialect.BC: "BC",
    GcodeDialect.LINUXCNC: "RPY",
    GcodeDialect.PLAIN: "none",
}
TILTING = [form for form in GcodeDialect if form is not GcodeDialect.PLAIN]
MICRODEGREE = np.radians(1e-6)
FEED_UNIT = 1e-3 / 60
"""mm/s in the last decimal of F."""
RIGHT = np.eye(3)


def read_back(text, written, form):
    options = ReadOptions(tools=written.tools, default_tool=BALL, axis_words=READER_WORDS[form])
    back, faults = read(text, "back.ngc", options)
    assert not faults
    return back


def round_trip(given, form, **numbers):
    text, diagnostics = write(given, form, **numbers)
    assert {one.code for one in diagnostics} <= {"G505"}  # steep turns of a random job; no loss
    assert "-0.0000 " not in text
    return read_back(text, given, form)


def assert_same(back, given, unit, axis_error, feed_unit=FEED_UNIT):
    """All that text can say is the same within the last decimal."""
    np.testing.assert_array_equal(back.kind, given.kind)
    np.testing.assert_allclose(back.position, given.position, rtol=0, atol=0.51 * unit)
    assert angle_between(back.tool_axis, given.tool_axis).max() <= axis_error
    np.testing.assert_allclose(back.feed, given.feed, rtol=0, atol=0.51 * feed_unit)
    np.testing.assert_array_equal(back.arc_axis, given.arc_axis)
    # The start and the distance to the centre are rounded, and the centre may be moved to fit the end.
    in_plane = (back.arc_centre - given.arc_centre) * (given.arc_axis == 0)
    assert np.nanmax(norm(in_plane), initial=0.0) <= 4 * unit
    np.testing.assert_array_equal(back.exact_stop, given.exact_stop)
    np.testing.assert_array_equal(back.exact_path, given.exact_path)
    np.testing.assert_allclose(back.tip_tolerance, given.tip_tolerance, rtol=0, atol=0.51 * unit / 100)
    np.testing.assert_allclose(back.side_offset, given.side_offset, rtol=0, atol=0.51 * unit)
    on = given.side_offset != 0
    np.testing.assert_array_equal(back.plane[on], given.plane[on])
    assert back.events == given.events


def arcs_in_all_planes(rng, count=60):
    """Arcs, helices and full circles of all planes and hands between lines, with stops and events."""
    position = np.zeros((count, 3))
    kind = np.where(rng.random(count) < 0.6, Kind.ARC, Kind.LINE)
    kind[0] = Kind.RAPID
    centre, turn = np.full((count, 3), np.nan), np.full((count, 3), np.nan)
    for row in range(1, count):
        if kind[row] != Kind.ARC:
            position[row] = position[row - 1] + rng.normal(size=3) * 10
            continue
        normal = rng.integers(3)
        first, second = RIGHT[normal - 2], RIGHT[normal - 1]
        begin, radius = rng.uniform(0, 7), 10 ** rng.uniform(-0.5, 2)
        sweep = rng.choice([rng.uniform(0.1, 6), 2 * np.pi])
        hand = rng.choice([-1, 1])
        centre[row] = position[row - 1] - radius * (np.cos(begin) * first + np.sin(begin) * second)
        turn[row] = hand * RIGHT[normal]
        last = begin + hand * sweep if sweep < 6.2 else begin
        position[row] = centre[row] + radius * (np.cos(last) * first + np.sin(last) * second)
        if sweep > 6.2:
            position[row] = position[row - 1]
        position[row] += rng.choice([0, 1]) * rng.normal() * RIGHT[normal]
    events = (
        Event(0, EventKind.TOOL_CHANGE, 1),
        Event(0, EventKind.SPINDLE, 12000.0),
        Event(3, EventKind.COOLANT, 1.0),
        Event(7, EventKind.STOP, 1.0),
        Event(7, EventKind.DWELL, 0.25),
        Event(9, EventKind.COOLANT, 2.0),
        Event(9, EventKind.SPINDLE, -500.5),
        Event(12, EventKind.STOP, 0.0),
        Event(count, EventKind.COOLANT, 0.0),
        Event(count, EventKind.SPINDLE, 0.0),
    )
    given = program(position, kind=kind, centre=centre, turn=turn, events=events)
    mode = rng.integers(0, 3, count)
    tolerance = np.where(mode == 0, rng.choice([0.0, 0.05, 0.001, 1.25], count), 0.0)
    return replace(given, exact_stop=mode == 1, exact_path=mode == 2, tip_tolerance=tolerance)


def test_text_of_a_small_job():
    text, diagnostics = write(square_with_arc(), GcodeDialect.VECTOR)
    assert diagnostics == ()
    # Checked by eye against the job.
    assert text.splitlines()[2:] == [
        "G21 G17 G90 G94 G40 G49 G80 G64",
        "(operation: Finish)",
        "G49",
        "T1 M6",
        "G43.5 H1",
        "G0 X0.0000 Y0.0000 Z60.0000 I0.000000 J0.000000 K1.000000",
        "G1 Z40.0000 F1800.000",
        "X30.0000",
        "G3 Y20.0000 I0.0000 J10.0000",
        "G1 X0.0000",
        "Y0.0000",
        "G2 Z36.0000 I5.0000 J0.0000",
        "M2",
    ]


@pytest.mark.parametrize(
    ("tool", "comment"),
    [
        (Tool(1, "", 0.0, 0.0, 0.0), "(tool 1)"),
        (Tool(1, "", 0.0, 0.0, 120.0), "(tool 1, length 120 mm)"),
        (Tool(1, "Drill", 6.8, 0.0, 0.0, corner_known=False), "(tool 1: Drill, diameter 6.8 mm)"),
        (Tool(1, "Ball", 10.0, 5.0, 120.5), "(tool 1: Ball, diameter 10 mm, corner radius 5 mm, length 120.5 mm)"),
    ],
)
def test_what_is_not_known_of_a_tool_or_an_operation_is_not_written_as_0_or_as_nothing(tool, comment):
    given = replace(square_with_arc(), tools={1: tool}, operations=("",))
    lines = write(given, GcodeDialect.PLAIN)[0].splitlines()
    assert lines[1] == comment
    assert not [line for line in lines if "operation" in line]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("form", TILTING)
def test_a_random_job_is_read_back_as_it_was(form, seed):
    given = random_job(np.random.default_rng(seed))
    error = 1e-6 if form is GcodeDialect.VECTOR else 2 * MICRODEGREE
    assert_same(round_trip(given, form), given, 1e-4, error + POLE)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("form", GcodeDialect)
def test_arcs_and_events_are_read_back_as_they_were(form, seed):
    given = arcs_in_all_planes(np.random.default_rng(seed))
    assert_same(round_trip(given, form), given, 1e-4, POLE)


@pytest.mark.parametrize("form", GcodeDialect)
def test_inches_are_read_back_as_millimetres(form):
    given = arcs_in_all_planes(np.random.default_rng(5))
    assert_same(round_trip(given, form, inch=True), given, 25.4e-6, POLE, 25.4 * FEED_UNIT)


def test_a_long_program_is_read_back_as_it_was():
    rows = 20000  # several pieces of formatting
    given = cone(rows, turns=40)
    given = replace(given, events=tuple(Event(row, EventKind.DWELL, 1.5) for row in (0, 8191, 8192, 16384, rows)))
    assert_same(round_trip(given, GcodeDialect.AC), given, 1e-4, 2 * MICRODEGREE)


def test_compensation_is_read_back_with_its_plane():
    given = square_with_arc()
    given = replace(given, side_offset=[0, 0, 3.125, 3.125, -2, 0, 1], plane=[2, 2, 2, 2, 0, 2, 2])
    back = round_trip(given, GcodeDialect.PLAIN)
    assert_same(back, given, 1e-4, POLE)


def test_compensation_may_change_its_plane_from_row_to_row():
    given = program([[0, 0, 0], [1, 0, 0], [1, 2, 0], [1, 2, 3]])
    given = replace(given, side_offset=[0, 2, 2, 0], plane=[2, 2, 1, 2])
    assert_same(round_trip(given, GcodeDialect.PLAIN), given, 1e-4, POLE)


def test_a_move_to_the_same_place_stays_a_row():
    given = program([[1, 2, 3], [1, 2, 3], [1, 2, 3]])
    assert len(round_trip(given, GcodeDialect.PLAIN)) == 3


@pytest.mark.parametrize("decimals", [2, 3])
def test_arcs_with_few_decimals_still_fit_their_ends(decimals):
    given = arcs_in_all_planes(np.random.default_rng(8))
    text, _ = write(given, GcodeDialect.PLAIN, decimals=decimals)
    back = read_back(text, given, GcodeDialect.PLAIN)
    rows = np.flatnonzero(back.kind == Kind.ARC)
    across = back.arc_axis[rows] == 0
    first, last = (
        norm((points - back.arc_centre[rows]) * across) for points in (back.position[rows - 1], back.position[rows])
    )
    assert len(rows) > 10
    assert np.abs(first - last).max() < 0.0025  # the strictest reader known allows 0.00254 mm


def test_an_oblique_arc_becomes_lines_near_it():
    axis = np.array([0, 1, 1]) / np.sqrt(2)
    start, across = np.array([10.0, 0, 0]), np.cross(axis, [1.0, 0, 0])
    given = program([start, 10 * across], kind=[Kind.RAPID, Kind.ARC], centre=np.zeros((2, 3)), turn=[axis, axis])
    given = replace(given, events=(Event(2, EventKind.DWELL, 1.0),), exact_stop=[False, True])
    text, diagnostics = write(given, GcodeDialect.VECTOR)
    assert [one.code for one in diagnostics] == ["G503"]
    back = read_back(text, given, GcodeDialect.VECTOR)
    assert (back.kind[1:] == Kind.LINE).all()
    middle = (back.position[:-1] + back.position[1:]) / 2
    assert np.abs(norm(back.position) - 10).max() < 1e-4
    assert 10 - norm(middle).min() < CHORD_ERROR + 1e-4
    assert back.events == (Event(len(back), EventKind.DWELL, 1.0),)
    assert back.exact_stop.sum() == 1
    assert back.exact_stop[-1]


def test_an_arc_that_turns_the_tool_is_lines_as_vectors_and_an_arc_as_angles():
    given = square_with_arc()
    tilted = np.array([0.6, 0, 0.8])
    given = replace(given, tool_axis=np.where(np.arange(7)[:, None] < 3, [0, 0, 1.0], tilted))
    assert_same(round_trip(given, GcodeDialect.BC), given, 1e-4, 2 * MICRODEGREE)
    text, diagnostics = write(given, GcodeDialect.VECTOR)
    assert [one.code for one in diagnostics] == ["G503"]
    back = read_back(text, given, GcodeDialect.VECTOR)
    assert angle_between(back.tool_axis[-1], tilted) < 1e-6
    assert (np.diff(angle_between(back.tool_axis, tilted)) <= 1e-6).all()


def test_three_axes_refuse_a_tilted_tool():
    text, (diagnostic,) = write(cone(5), GcodeDialect.PLAIN)
    assert text is None
    assert diagnostic.code == "G501"
    assert diagnostic.place.line == 1


def test_linuxcnc_refuses_a_tool_that_hangs():
    text, (diagnostic,) = write(program(np.zeros((2, 3)), [[0, 0, 1.0], [0, 0, -1.0]]), GcodeDialect.LINUXCNC)
    assert text is None
    assert diagnostic.code == "G502"
    assert diagnostic.place.line == 2


@pytest.mark.parametrize("form", [GcodeDialect.AC, GcodeDialect.BC])
def test_c_rests_when_the_tool_swings_through_the_pole(form):
    tilt = np.radians(np.arange(-20.0, 21.0, 5.0))
    axis = np.column_stack([0.6 * np.sin(tilt), 0.8 * np.sin(tilt), np.cos(tilt)])
    angles = NOTATIONS[form].values(axis, np.zeros(len(axis)))
    steps = np.diff(angles, axis=0)
    np.testing.assert_allclose(steps, np.tile(steps[0], (8, 1)), atol=1e-9)
    np.testing.assert_allclose(np.abs(steps[0]), [5.0, 0.0], atol=1e-9)


def test_c_turns_on_over_several_turns():
    axis = cone(400, turns=3.0).tool_axis
    c = NOTATIONS[GcodeDialect.BC].values(axis, np.zeros(len(axis)))[:, 1]
    assert c[-1] - c[0] == pytest.approx(3 * 360)
    assert np.diff(c).max() < 3.0


def test_c_turns_while_the_tool_stands_upright():
    tilt = np.radians([10, 0, 0, 0, 10])
    azimuth = np.radians([0, 0, 0, 0, 60])
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    np.testing.assert_allclose(
        NOTATIONS[GcodeDialect.BC].values(axis, np.zeros(len(axis)))[:, 1], [0, 0, 60, 60, 60], atol=1e-9
    )


def test_angles_of_linuxcnc_have_no_torsion():
    axis = random_job(np.random.default_rng(4)).tool_axis
    a, b, c = np.radians(NOTATIONS[GcodeDialect.LINUXCNC].values(axis, np.zeros(len(axis)))).T
    zero, one = np.zeros_like(a), np.ones_like(a)

    def rows(*entries):
        return np.stack(entries, axis=-1).reshape(-1, 3, 3)

    about_x = rows(one, zero, zero, zero, np.cos(a), -np.sin(a), zero, np.sin(a), np.cos(a))
    about_y = rows(np.cos(b), zero, np.sin(b), zero, one, zero, -np.sin(b), zero, np.cos(b))
    about_z = rows(np.cos(c), -np.sin(c), zero, np.sin(c), np.cos(c), zero, zero, zero, one)
    np.testing.assert_allclose(about_z @ about_y @ about_x, platform_rotation(axis, zero), atol=1e-12)


def test_every_word_is_said_again_after_a_tool_change():
    given = program(np.ones((4, 3)), events=(Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 1)))
    text, _ = write(given, GcodeDialect.BC)
    assert text.splitlines()[-2:] == ["X1.0000", "M2"]
    assert text.splitlines()[-3] == "G1 X1.0000 Y1.0000 Z1.0000 B0.000000 C0.000000 F1800.000"


def test_a_program_without_rows_is_a_heading_and_an_end():
    text, diagnostics = write(program(np.zeros((0, 3)), kind=[], axis=np.zeros((0, 3)), events=()), GcodeDialect.VECTOR)
    assert diagnostics == ()
    assert text.splitlines()[-3:] == ["G21 G17 G90 G94 G40 G49 G80 G64", "G43.5", "M2"]


def test_normals_that_are_left_out_are_reported():
    given = square_with_arc()
    _, diagnostics = write(replace(given, normal=np.tile([0, 0, 1.0], (7, 1))), GcodeDialect.PLAIN)
    assert [one.code for one in diagnostics] == ["G504"]


def test_comments_hold_no_parentheses_and_one_line():
    text, _ = write(
        replace(square_with_arc(), operations=("Tasche (tief)\nM3 100 %",), source="x" * 300), GcodeDialect.PLAIN
    )
    assert max(map(len, text.splitlines())) < 255
    assert "(operation: Tasche [tief] M3 100 %)" in text.splitlines()


@pytest.mark.parametrize("column", ["position", "tool_axis", "feed", "side_offset"])
def test_a_value_that_is_no_number_is_the_callers_fault(column):
    given = square_with_arc()
    values = getattr(given, column).copy()
    values[-1] = np.nan
    with pytest.raises(ValueError, match=column):
        write(replace(given, **{column: values}), GcodeDialect.PLAIN)


def leaning(tilt, azimuth):
    return np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])


@pytest.mark.parametrize("form", [GcodeDialect.AC, GcodeDialect.BC])
@pytest.mark.parametrize(("tilt", "turn"), [(5.0, 3.0), (20.0, 10.0), (40.0, 60.0)])
def test_a_head_that_turns_c_alone_swings_past_the_great_circle(form, tilt, turn):
    tilt, turn = np.radians(tilt), np.radians(turn)
    # Halfway C keeps the tilt t; the great circle is at atan(tan t cos(turn / 2)) there: a right spherical triangle.
    expected = tilt - np.arctan(np.tan(tilt) * np.cos(turn / 2))
    swing = axis_deviation(leaning(np.array([tilt, tilt]), np.array([0.3, 0.3 + turn])), np.zeros(2), form)
    np.testing.assert_allclose(swing, [0.0, expected], rtol=0, atol=1e-12)


@pytest.mark.parametrize("form", GcodeDialect)
def test_a_head_that_tilts_alone_stays_on_the_great_circle(form):
    axis = leaning(np.radians([0.0, 10.0, 30.0]), np.zeros(3))
    np.testing.assert_allclose(axis_deviation(axis, np.zeros(len(axis)), form), 0.0, atol=1e-12)


def test_swings_of_cutting_moves_are_reported():
    axis = leaning(np.radians(np.full(4, 20.0)), np.radians([0.0, 1.0, 31.0, 61.0]))
    given = program(np.zeros((4, 3)), axis, kind=[Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID])
    (reported,) = write(given, GcodeDialect.BC)[1]
    assert (reported.code, reported.place.line) == ("G505", 3)
    swing = axis_deviation(axis, np.zeros(4), GcodeDialect.BC)
    assert reported.found == f"by up to {np.degrees(swing[2]):.2f} deg in 1 cutting moves, this is the first"
    assert swing[1] < MAX_AXIS_DEVIATION < swing[2]
    assert write(given, GcodeDialect.VECTOR)[1] == ()


@pytest.mark.parametrize(
    ("feed", "inch", "written"), [(0.0004, False, None), (0.0006, False, "F0.001"), (0.01, True, None)]
)
def test_a_feed_is_never_written_as_zero(feed, inch, written):
    text, diagnostics = write(program(np.eye(3), feed=feed / 60), GcodeDialect.PLAIN, inch=inch)
    assert (text is None) == (written is None)
    if text is None:
        assert [(one.code, one.place.line) for one in diagnostics] == [("G506", 2)]
    else:
        assert written in text


def test_the_spin_of_a_hexapod_is_written_and_read():
    random = np.random.default_rng(12)
    angles = np.column_stack([random.uniform(-30, 30, (40, 2)), random.uniform(-50, 50, 40)])
    blocks = [f"G1 X{row} Y0 Z0 A{a:.4f} B{b:.4f} C{c:.4f} F100" for row, (a, b, c) in enumerate(angles)]
    options = ReadOptions(axis_words="RPY", default_tool=Tool(1, "", 10.0, 0.0, 50.0))
    first, _ = read("G21 G90\nG0 X0 Y0 Z0\n" + "\n".join(blocks) + "\nM2\n", "a.ngc", options)
    assert np.ptp(first.spin) > 0.5
    text, _ = write(first, GcodeDialect.LINUXCNC, decimals=6)
    again, _ = read(text, "b.ngc", options)
    np.testing.assert_allclose(again.spin, first.spin, atol=1e-6)
    for form in (GcodeDialect.VECTOR, GcodeDialect.AC):
        text, _ = write(first, form)
        words = "vector" if form is GcodeDialect.VECTOR else "AC"
        assert np.isnan(read(text, "c.ngc", dataclasses.replace(options, axis_words=words))[0].spin).all()
