# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands of operations become columns: modal words, tool axes, arcs, events, and every fault with its place."""

import inspect

import FreeCAD as App
import numpy as np
import Part
import Path
import pytest

from pkm_post.freecad_app.commands import read_commands
from pkm_post.model import EventKind, Kind, threads

FIRST = "G0 X0 Y0 Z10"
SIX_DECIMALS = 1e-6


def commands(*lines):
    return [Path.Command(line) for line in lines]


def read(*lines, **start):
    return read_commands(commands(*lines), "part.FCStd", "Cut", **start)


def program_of(*lines, **start):
    program, faults = read(*lines, **start)
    assert faults == ()
    return program


def faults_of(*lines):
    _, faults = read(*lines)
    return [(fault.code, fault.place.line) for fault in faults]


def test_words_stay_in_force():
    program = program_of(FIRST, "G1 X5 F2", "G1 Z-1", "G0 Y7", "G1 X6")
    np.testing.assert_array_equal(program.position, [[0, 0, 10], [5, 0, 10], [5, 0, -1], [5, 7, -1], [6, 7, -1]])
    np.testing.assert_array_equal(program.feed, [np.nan, 2, 2, np.nan, 2])
    np.testing.assert_array_equal(program.kind, [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID, Kind.LINE])
    np.testing.assert_array_equal(program.tool_axis, [[0, 0, 1]] * 5)


def test_numbers_count_as_a_saved_document_has_them():
    """FreeCAD's own writing of a path is the oracle; binary fractions, and of inches, lie between two numbers."""
    random = np.random.default_rng(1)
    whole = random.integers(-(10**6), 10**6, 2000)
    some = [random.normal(size=2000) * 10 ** random.uniform(-8, 3, 2000), whole * 25.4 / 128, whole / 2048]
    numbers = np.concatenate([*some, [0.0, -0.0, -3e-7, 5e-7, 99999.9999995]]).tolist()
    path = Path.Path([Path.Command("G1", {"X": each, "Y": 0.0, "Z": 0.0, "F": 1.0}) for each in numbers])
    saved = Path.Path()
    saved.setFromGCode(path.toGCode())
    made, stored = (read_commands(each.Commands, "part.FCStd", "Cut")[0].position for each in (path, saved))
    np.testing.assert_array_equal(made, stored)
    np.testing.assert_array_equal(stored[:, 0], [command.Parameters["X"] for command in saved.Commands])


def test_names_with_leading_zeros_and_small_letters():
    program = program_of("g00 x0 y0 z10", "g01 x5 f2", "G02 X7 I1 J0", "G03 X9 I1 J0")
    np.testing.assert_array_equal(program.kind, [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.ARC])


def test_moves_before_the_first_known_place_are_folded_into_it():
    program = program_of("(Cut)", "G0 Z10", "M3 S100", "G0 X1 Y2", "G1 Z0 F1")
    np.testing.assert_array_equal(program.position, [[1, 2, 10], [1, 2, 0]])
    np.testing.assert_array_equal(program.line, [4, 5])
    assert [(event.row, event.kind) for event in program.events] == [(0, EventKind.SPINDLE)]


def test_known_start_makes_every_move_complete():
    program = program_of("G0 Z10", "G0 X1 Y2", start=(7.0, 8.0, 9.0))
    np.testing.assert_array_equal(program.position, [[7, 8, 10], [1, 2, 10]])


def test_tool_axis_is_modal_and_reaches_back_to_the_beginning():
    program = program_of("G0 X0 Y0 Z9", "G1 X1 I0 J0.6 K0.8 F1", "G0 X2", "G1 X3 I1 J0 K0")
    expected = [[0, 0.6, 0.8], [0, 0.6, 0.8], [0, 0.6, 0.8], [1, 0, 0]]
    np.testing.assert_allclose(program.tool_axis, expected, atol=1e-15)


def test_tool_axis_stays_during_an_arc():
    program = program_of(FIRST, "G1 X0 I0 J0.6 K0.8 F1", "G2 X10 I5 J0")
    np.testing.assert_allclose(program.tool_axis[2], [0, 0.6, 0.8], atol=1e-15)


def test_rounded_tool_axes_are_made_unit_again_without_a_word():
    program = program_of(FIRST, "G1 X1 I0.577350 J0.577350 K0.577350 F1")
    np.testing.assert_allclose(np.linalg.norm(program.tool_axis, axis=1), 1.0, atol=1e-15)


def test_long_tool_axis_is_made_unit_and_reported_once():
    program, faults = read(FIRST, "G1 X1 I0 J3 K4 F1", "G1 X2 I0 J6 K8")
    np.testing.assert_allclose(program.tool_axis[1:], [[0, 0.6, 0.8]] * 2, atol=1e-15)
    assert [(fault.code, fault.place.line) for fault in faults] == [("J118", 2)]
    assert "length 5, and 1 more" in faults[0].found


def test_clockwise_and_counterclockwise_arcs():
    program = program_of(FIRST, "G2 X10 Y0 I5 J0 K0 F1", "G3 X10 Y0 Z4 I-2", "G3 X10 Y6 J3")
    np.testing.assert_array_equal(program.arc_axis[1:], [[0, 0, -1], [0, 0, 1], [0, 0, 1]])
    np.testing.assert_array_equal(program.arc_centre[1:], [[5, 0, 10], [8, 0, 10], [10, 3, 4]])
    assert np.all(np.isnan(program.arc_axis[0]))
    np.testing.assert_array_equal(program.position[2], [10, 0, 4])


def test_arc_that_fits_to_a_few_microns_is_taken():
    assert len(program_of(FIRST, "G2 X10.004 Y0 I5 J0 F1")) == 2


def test_what_happens_between_moves():
    lines = ["M6 T3", "M4 S800", FIRST, "G4 P0.5", "M8", "G1 X1 F1", "M7", "M9", "M0", "M1", "M5"]
    events = [(event.row, event.kind, event.value) for event in program_of(*lines).events]
    assert events == [
        (0, EventKind.TOOL_CHANGE, 3),
        (0, EventKind.SPINDLE, -800),
        (1, EventKind.DWELL, 0.5),
        (1, EventKind.COOLANT, 1),
        (2, EventKind.COOLANT, 2),
        (2, EventKind.COOLANT, 0),
        (2, EventKind.STOP, 0),
        (2, EventKind.STOP, 1),
        (2, EventKind.SPINDLE, 0),
    ]


def test_harmless_codes_and_comments_pass():
    codes = ["G17", "G21", "G40", "G49", "G54", "G80", "G90", "G94", "G98", "G99", "(a comment)", ""]
    assert len(program_of(*codes, FIRST, "G1 X1 F1")) == 2


def test_no_commands_give_no_rows():
    assert len(program_of()) == 0
    assert len(program_of("(inactive operation)")) == 0


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("G20", "J104"),
        ("G91", "J104"),
        ("G43 H1", "J104"),
        ("G55", "J104"),
        ("G64 P-1", "J104"),
        ("G61 P1", "J104"),
        ("G84 X1 Y1 Z1 R1 F1", "J123"),
        ("G74 X1 Y1 Z1 R1 F1 S100", "J123"),
        ("G33.1 Z1 K1", "J123"),
        ("G81 Z1 R1 L2 F1", "J104"),
        ("M30", "J104"),
        ("M3", "J104"),
        ("M6", "J104"),
        ("M6 T1.5", "J104"),
        ("G4", "J104"),
        ("G4 P-1", "J104"),
        ("G17 G21", "J144"),
        ("X5 Y5", "J144"),
        ("F5", "J144"),
        ("S900 M3", "J144"),
        ("G1 X1e-3 F1", "J104"),  # FreeCAD reads X1 and E-3
        ("G2 X10 R5 I5 F1", "J104"),
        ("G1 X1", "J105"),
        ("G1 X1 F0", "J105"),
        ("G1 X1 F-2", "J105"),
        ("G2 X10 I5 J0 K1 F1", "J106"),
        ("G2 X10 F1", "J107"),
        ("G2 X10.02 I5 J0 F1", "J107"),
        ("G2 X0 Y0 I0 J0 F1", "J107"),
        ("G1 X1 I1 J0 F1", "J109"),
        ("G0 X1 K1", "J109"),
        ("G1 X1 I0 J0 K0 F1", "J110"),
        ("G1 X1 A30 F1", "J115"),
        ("G0 C90", "J115"),
    ],
)
def test_faults_are_reported_with_their_place(line, code):
    program, faults = read("(Cut)", FIRST, line)
    assert program is None
    assert [(fault.code, fault.place.line) for fault in faults] == [(code, 3)]
    assert str(faults[0]).startswith(f"part.FCStd: Cut: line 3: error {code}")


def test_feed_of_a_rapid_move_is_no_feed_for_cutting():
    assert faults_of("G0 X0 Y0 Z10 F50", "G1 X1") == [("J105", 2)]


def test_arcs_in_other_planes():
    assert faults_of("G18", FIRST, "G1 X2 F1", "G17", "G2 X12 I5 J0") == []
    assert faults_of("G18", FIRST, "G2 X10 I5 J0 F1") == [("J106", 3)]
    assert faults_of("G19", FIRST, "G3 X10 I5 J0 F1") == [("J106", 3)]


def test_a_rounding_error_in_k_is_no_other_plane():
    """Lead-ins above tags write K-1.4e-17 in FreeCAD 1.0; a saved document has six decimals."""
    arc = {"X": 10.0, "Y": 0.0, "I": 5.0, "J": 0.0, "F": 1.0}

    def found(k):
        path = [*commands(FIRST), Path.Command("G2", arc | {"K": k})]
        return [fault.code for fault in read_commands(path, "part.FCStd", "Cut")[1]]

    assert found(-1.43779e-17) == found(4e-7) == []
    assert found(2e-6) == ["J106"]


def test_arc_from_nowhere():
    assert faults_of("G2 X10 Y0 Z0 I5 J0 F1") == [("J107", 1)]


def test_cutting_move_without_the_tool_axis_that_others_have():
    lines = [FIRST, "G1 X1 I0 J0 K1 F1", "G1 X2", "G0 X3", "G1 X4"]
    _, faults = read(*lines)
    assert [(fault.code, fault.place.line) for fault in faults] == [("J109", 3)]
    assert "and 1 more" in faults[0].found


def test_a_dwell_of_more_than_a_minute_is_reported():
    """CAM has seconds: its Drilling writes the property DwellTime as P, and its linuxcnc post hands that on."""
    program, faults = read(FIRST, "G82 X1 Z-1 R1 P500 F1", "G4 P60", "G4 P61")
    assert [(fault.code, fault.place.line, fault.found) for fault in faults] == [
        ("J124", 2, "G82 P500, and 1 more like it")
    ]
    assert [event.value for event in program.events] == [500, 60, 61]


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("letter", ["X", "F", "I"])
def test_numbers_that_are_none(letter, number):
    words = {"X": 1.0, "Y": 1.0, "Z": 1.0, "I": 0.0, "J": 0.0, "K": 1.0, "F": 1.0} | {letter: number}
    program, faults = read_commands([Path.Command("G1", words)], "part.FCStd", "Cut")
    assert program is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("J119", 1)]


def test_all_faults_are_reported_in_one_run_in_order():
    assert faults_of(FIRST, "G1 X1", "G86 Z1", "G2 X9", "G1 B1", "G86 Z2", "G1 X1 I0 J0 K0") == [
        ("J105", 2),
        ("J109", 2),
        ("J104", 3),
        ("J107", 4),
        ("J115", 5),
        ("J110", 7),
    ]


def test_tapping_has_its_lead_in_f_where_the_spindle_is_an_axis():
    taps = "G98", "G84 X10 Y5 Z-4 R2 F1.25 S600 P0.5", "G84 X20 Y5 Z-4 R2 F1.25 S600", "G80", "G0 Z20"
    program = program_of(FIRST, *taps, spindle_axis=True)
    assert [thread.lead for thread in threads(program.events)] == [1.25, 1.25]
    first = threads(program.events)[0].first
    assert program.position[first : first + 2, 2].tolist() == [-4.0, 2.0]
    assert program.feed[first] == 12.5
    assert [event.value for event in program.events if event.kind is EventKind.DWELL] == [0.5, 0.5]


@pytest.mark.parametrize("line", ["G84 X1 Y1 Z1 R2 S600", "G84 X1 Y1 Z1 R2 F1.25", "G33.1 Z1 K1"])
def test_tapping_without_its_lead_is_refused(line):
    program, faults = read(FIRST, line, spindle_axis=True)
    assert program is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("J123", 2)]


def test_the_cycle_of_cams_own_generator_is_read():
    tapping = pytest.importorskip("Path.Base.Generator.tapping")
    if "pitch" not in inspect.signature(tapping.generate).parameters:
        pytest.skip("this FreeCAD writes no lead")
    edge = Part.makeLine(App.Vector(10, 5, 0), App.Vector(10, 5, -8))
    (made,) = tapping.generate(edge, 0.0, 1, 2.0, False, 1.5, 400.0)
    program, faults = read_commands([*commands(FIRST), made], "part.FCStd", "Cut", spindle_axis=True)
    assert faults == ()
    assert [thread.lead for thread in threads(program.events)] == [-1.5]
