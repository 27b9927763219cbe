# SPDX-License-Identifier: LGPL-2.1-or-later
"""What blocks mean: small programs, and the rows and events they have to give."""

import numpy as np
import pytest

from pkm_post.model import EventKind, Kind, Tool
from pkm_post.reading import gcode
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan

MICRON = 1e-3
NANOMETRE = 1e-6
INCH = 25.4
TOOLS = {1: Tool(1, "end mill", 10.0, 0.0, 60.0), 2: Tool(2, "drill", 5.0, 0.0, 90.0)}
START = "G0 X0 Y0 Z5\n"


def read(text, **options):
    blocks, faults = scan(text, "part.ngc")
    assert not faults
    program, faults = resolve(blocks, ReadOptions(**({"tools": TOOLS} | options)))
    assert program is not None, faults
    return program


def happened(program):
    return [(event.row, event.kind, event.value) for event in program.events]


def near(actual, expected, tolerance=NANOMETRE):
    np.testing.assert_allclose(actual, expected, rtol=0, atol=tolerance)


def test_words_and_modes_stay_in_force():
    program = read("G0 X1 Y2 Z3\nG1 X4 F600\nY5\nG0 Z9\n")
    assert program.kind.tolist() == [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID]
    near(program.position, [[1, 2, 3], [4, 2, 3], [4, 5, 3], [4, 5, 9]])
    near(program.feed, [np.nan, 10, 10, np.nan])
    assert program.line.tolist() == [1, 2, 3, 4]
    near(program.tool_axis, np.tile([0, 0, 1], (4, 1)))


def test_moves_before_the_place_is_known_are_folded_into_the_first_that_has_one():
    program = read("G0 Z50\nM3 S1000\nX1\nY2\nX3\n")
    near(program.position, [[1, 2, 50], [3, 2, 50]])
    assert happened(program) == [(0, EventKind.SPINDLE, 1000)]


def test_a_start_that_is_known_makes_every_move_one():
    near(read("G0 Z50\nX1\n", start=(7.0, 8.0, 9.0)).position, [[7, 8, 50], [1, 8, 50]])


def test_inches_are_inches_from_their_code_on():
    program = read("G0 X1 Y1 Z1\nG20 G1 X1 F10\nG21 X1\n")
    near(program.position[:, 0], [1, INCH, 1])
    near(program.feed[1:], 10 * INCH / 60)
    near(read("G0 X1 Y1 Z1\n", unit="inch").position, [[INCH] * 3])


@pytest.mark.parametrize(
    ("block", "axis", "centre"),
    [
        ("G17 G2 X10 Y0 I5 J0", [0, 0, -1], [5, 0, 5]),
        ("G17 G3 X10 Y0 I5 J0 K0", [0, 0, 1], [5, 0, 5]),
        ("G18 G2 X10 Z5 I5 K0", [0, -1, 0], [5, 0, 5]),
        ("G19 G3 Y10 Z5 J5 K0", [1, 0, 0], [0, 5, 5]),
        ("G17 G3 X10 Y0 R5", [0, 0, 1], [5, 0, 5]),
        ("G17 G90.1 G3 X10 Y0 I5 J0", [0, 0, 1], [5, 0, 5]),
    ],
)
def test_arcs_have_centre_and_axis(block, axis, centre):
    program = read(f"{START}F100 {block}\n")
    assert program.kind[1] == Kind.ARC
    near(program.arc_centre[1], centre)
    near(program.arc_axis[1], axis)


def test_a_long_arc_has_a_negative_radius():
    near(read(f"{START}G3 X10 Y0 R13 F100\n").arc_centre[1], [5, 12, 5])
    near(read(f"{START}G3 X10 Y0 R-13 F100\n").arc_centre[1], [5, -12, 5])


def test_turns_are_cut_where_they_are_full():
    program = read(f"{START}G3 X0 Y0 Z-4 I5 P3 F100\n")
    near(program.position[:, 2], [5, 2, -1, -4])
    near(program.position[:, 0], 0)


def test_a_mirror_turns_arcs_and_compensation_round():
    text = f"{START}G51.1 X0\nG41.1 D6 G1 X10 F100\nG3 X20 I5\nG40 G1 X30\n"
    program = read(text)
    near(program.position[1:, 0], [-10, -20, -30])
    near(program.arc_axis[2], [0, 0, -1])
    near(program.side_offset, [0, -3, -3, 0])
    assert program.plane.tolist() == [2, 2, 2, 2]


def test_side_and_radius_may_change_under_compensation():
    program = read(f"{START}G41.1 D6 G1 X10 F100\nG42.1 D6 X20\nG42.1 D8 X30\nG40 X40\n")
    near(program.side_offset, [0, 3, -3, -4, 0])


def test_a_quarter_turn_takes_the_plane_along():
    program = read(f"{START}G19 G68 Y0 Z0 R90\nG17 G41 D1 G1 X10 F100\n")
    assert program.plane.tolist() == [2, 1]
    near(program.side_offset[1], -5)


def test_a_length_offset_of_the_tool_itself_moves_nothing():
    text = "T1 M6\nG43 H{}\nG0 X0 Y0 Z10\n"
    near(read(text.format(1)).position, [[0, 0, 10]])
    near(read(text.format(2)).position, [[0, 0, 40]])
    near(read("T1 M6\nG0 X0 Y0 Z10\n").position, [[0, 0, 10]])


def test_the_tip_of_another_tool_is_elsewhere_under_the_same_offset():
    near(read("T1 M6\nG43 H1\nG0 X0 Y0 Z10\nT2 M6\nG0 X1\n").position, [[0, 0, 10], [1, 0, -20]])


def test_the_only_work_offset_is_the_frame_of_the_program():
    near(read("G55\nG0 X1 Y2 Z3\n").position, [[1, 2, 3]])
    offsets = {"G54": (0.0, 0.0, 0.0, 0.0), "G55": (10.0, 0.0, 0.0, 90.0)}
    near(read("G0 X1 Y2 Z3\nG55 X1 Y2 Z3\n", work_offsets=offsets).position, [[1, 2, 3], [8, 1, 3]])


def test_home_is_where_the_options_or_the_program_say():
    home = (0.0, 0.0, 100.0)
    near(read(f"{START}G28 Z50\n", home=home).position, [[0, 0, 5], [0, 0, 50], [0, 0, 100]])
    near(read(f"{START}G28.1\nG0 X9 Z9\nG28\n").position[-1], [0, 0, 5])


def test_machine_coordinates_are_those_of_the_spindle_nose():
    offsets = {"G54": (10.0, 20.0, 30.0, 0.0)}
    text = "T1 M6\nG43 H1\nG0 X0 Y0 Z0\nG53 G0 Z200\n"
    near(read(text, work_offsets=offsets).position, [[10, 20, 30], [10, 20, 140]])


def test_a_peck_goes_back_to_where_it_was():
    program = read(f"{START}G99 G83 X1 Y0 Z-3 R2 Q2.5 F60\n")
    near(program.position[1:, 2], [5, 2, -0.5, 2, -0.246, -3, 2])
    assert program.kind[1:].tolist() == [0, 0, 1, 0, 0, 1, 0]


def test_dwell_and_spindle_of_a_cycle_are_events():
    program = read(f"M3 S500\n{START}G86 X1 Y0 Z-3 R2 P.5 F60\n")
    events = [(0, EventKind.SPINDLE, 500), (4, EventKind.DWELL, 0.5), (4, EventKind.SPINDLE, 0)]
    assert happened(program) == [*events, (5, EventKind.SPINDLE, 500)]


def test_what_happens_in_a_block_has_an_order():
    program = read("T1 M6\nG0 X0 Y0 Z0\nG1 X1 F60 M1 M8 M7 M4 S100 T2 M6\nX2 M30\nG12\n")
    assert happened(program) == [
        (0, EventKind.TOOL_CHANGE, 1),
        (1, EventKind.TOOL_CHANGE, 2),
        (1, EventKind.SPINDLE, -100),
        (1, EventKind.COOLANT, 1),
        (1, EventKind.COOLANT, 2),
        (2, EventKind.STOP, 1),
        (3, EventKind.SPINDLE, 0),
        (3, EventKind.COOLANT, 0),
    ]
    assert sorted(program.tools) == [1, 2]


@pytest.mark.parametrize("again, speed", [("", []), ("M3\n", [900]), ("M4 S600\n", [-600])])
@pytest.mark.parametrize("change", ["T2 M6 S900\n", "S900 T2 M6\n", "T2 M6\nS900\n", "T2 M6\nM0\nS900\n"])
def test_a_tool_change_leaves_the_spindle_stopped_until_it_is_started(change, again, speed):
    # rs274: STOP_SPINDLE_TURNING, CHANGE_TOOL; SET_SPINDLE_SPEED(900), and no START_SPINDLE before M3
    program = read(f"T1 M6\nG0 X0 Y0 Z0\nS500 M3\nG1 X1 F60\n{change}{again}X2\nM2\n")
    started = [value for row, kind, value in happened(program) if kind is EventKind.SPINDLE and row == 2]
    assert started == speed
    last = [value for _, kind, value in happened(program) if kind is EventKind.SPINDLE][-1]
    assert last == 0


def test_feeds_of_all_modes():
    program = read("G0 X0 Y0 Z0\nG93 G1 X30 F2\nG94 X0 F600\nG95 M3 S600 X1 F.5\n")
    near(program.feed[1:], [1, 10, 5])


def test_a_turn_in_place_takes_the_time_of_its_block():
    text = "T1 M6\nG43.5 H1 G0 X0 Y0 Z0 I0 J0 K1\nG93 G1 I1 K1 J0 F5\nX6 F5\nI1 J0 K0 F10\nX0 I0 J0 K1 F2\nX0 F3\n"
    near(read(text, axis_words="vector").feed[1:5], [45 * 5 / 60, 0.5, 45 * 10 / 60, 6 * 2 / 60])


def test_exact_stop_is_marked():
    assert read("G0 X0 Y0 Z0\nG61.1 G1 X1 F60\nG64 X2\n").exact_stop.tolist() == [False, True, False]


def test_deleted_blocks_are_left_out_when_asked():
    text = "G0 X0 Y0 Z0\n/G0 X1\n/M30\nG0 X2\n"
    assert read(text).line.tolist() == [1, 2]
    assert read(text, block_delete=True).line.tolist() == [1, 4]


def test_blocks_of_numbered_switches_are_left_out_when_asked():
    text = "G0 X0 Y0 Z0\n/2 G0 X1\n/9M30\nG0 X2\n"
    assert read(text).line.tolist() == [1, 2]
    assert read(text, block_delete=True).line.tolist() == [1, 4]


def test_a_default_tool_stands_in_for_those_that_are_missing():
    default = Tool(0, "any", 8.0, 0.0, 70.0)
    assert read(START, default_tool=default).tools == {0: default}
    assert read(f"T7 M6\n{START}", default_tool=default).tools == {7: Tool(7, "any", 8.0, 0.0, 70.0)}


SQUARE_ROOT = np.sqrt(0.5)


@pytest.mark.parametrize(
    ("axis_words", "words", "axis"),
    [
        ("BC", "B30 C0", [0.5, 0, np.sqrt(0.75)]),
        ("BC", "B90 C45", [SQUARE_ROOT, SQUARE_ROOT, 0]),
        ("AC", "A30 C0", [0, -0.5, np.sqrt(0.75)]),
        ("AC", "A90 C90", [1, 0, 0]),
        ("AB", "A0 B-30", [-0.5, 0, np.sqrt(0.75)]),
        ("RPY", "A90 B45 C90", [1, 0, 0]),
        ("vector", "I3 J0 K4", [0.6, 0, 0.8]),
    ],
)
def test_the_tool_axis_has_many_words(axis_words, words, axis):
    code = "G43.5" if axis_words == "vector" else "G43.4"
    program = read(f"T1 M6\n{code} H1\n{START}G1 X1 {words} F100\nX2\n", axis_words=axis_words)
    near(program.tool_axis, [[0, 0, 1], axis, axis])


@pytest.mark.parametrize("words", ["TRAORI\nG1 X1 A3=3 B3=0 C3=4 F100", "LN X1 Y0 Z0 TX3 TY0 TZ4 F100"])
def test_other_controls_write_vectors_in_other_words(words):
    program, faults = gcode.read(f"{START}{words}\n", "part.ngc", ReadOptions(axis_words="vector"))
    assert not faults
    near(program.tool_axis, [[0, 0, 1], [0.6, 0, 0.8]])
    _, faults = gcode.read(f"{START}{words}\n", "part.ngc")
    assert {fault.code for fault in faults} == {"G404"}


def test_relative_angles_add_up():
    program = read(f"T1 M6\nG43.4 H1\n{START}G91 G1 B10 F100\nB20\n", axis_words="BC")
    near(program.tool_axis[-1], [0.5, 0, np.sqrt(0.75)])


def test_i_j_k_of_an_arc_are_its_centre_whatever_the_dialect():
    program = read(f"G43.5\n{START}G1 I0 J1 K1 F60\nG3 X10 I5 J0\n", axis_words="vector")
    near(program.arc_centre[2], [5, 0, 5])
    near(program.tool_axis[2], [0, SQUARE_ROOT, SQUARE_ROOT])


def test_blocks_that_were_not_executed_are_refused():
    blocks, _ = scan("#1=2\nG0 X#1\n", "part.ngc")
    with pytest.raises(ValueError, match="expected plain blocks, got 2"):
        resolve(blocks, ReadOptions())


def test_options_that_do_not_exist_are_refused():
    with pytest.raises(ValueError, match="axis_words: expected one of none, vector, .* got 'XY'"):
        ReadOptions(axis_words="XY")
    with pytest.raises(ValueError, match="unit: expected one of mm, inch, got 'cm'"):
        ReadOptions(unit="cm")


def test_normals_hold_for_their_own_block_and_turn_with_the_frame():
    text = "LN X1 Y0 Z0 NX0.6 NY0 NZ0.8 F100\nLN X2\nG51.1 X0\nG68 X0 Y0 R90\nLN Y3 NX0.6 NY0 NZ0.8\n"
    program = read(START + text)
    near(program.normal[1], [0.6, 0, 0.8])
    assert np.isnan(program.normal[[0, 2]]).all()
    # Mirrored in X it points to -X, and a quarter turn on to -Y.
    near(program.normal[-1], [0, -0.6, 0.8])
    near(program.tool_axis[-1], [0, 0, 1])


def test_normals_and_tool_axes_stand_together():
    program = read(f"{START}LN X1 Y0 Z0 NX0 NY-1.0000002 NZ0 TX0 TY3 TZ4 F100\n", axis_words="vector")
    near(program.normal[1], [0, -1, 0])
    near(program.tool_axis[1], [0, 0.6, 0.8])


def test_without_normals_the_column_takes_no_memory():
    assert read("G0 X1 Y2 Z3\nG1 X4 F600\n").normal.strides[0] == 0


@pytest.mark.parametrize("words", ["A3=0 B3=0 C3=1", "A3=0 B3=0 C3=5"])
def test_an_upright_tool_may_be_handed_over(words):
    text = f"T1 M6\nTRAORI\n{START}G1 A3=1 B3=0 C3=1 F100\n{words}\nTRAFOOF\nX5\n"
    near(read(text, axis_words="vector").tool_axis[-1], [0, 0, 1])


def test_a_home_move_needs_no_tip_control():
    text = f"G43.5\n{START}G1 I1 J0 K1 F100\nG49\nG28\n"
    near(read(text, axis_words="vector", home=(0.0, 0.0, 99.0)).position[-1], [0, 0, 99])
