# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flavours of G-code: what words mean on controls of Fanuc's kind and in RS274NGC, and how the two are distinguished.

What Fanuc's controls do is from Fanuc, Series 15i/150i-MA Operator's Manual (Programming), B-63324EN, the chapters that
each test names; what RS274NGC does from LinuxCNC and its rs274.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from pkm_post import reading
from pkm_post.model import EventKind, Kind, Tool
from pkm_post.options.converters import GCODE_FLAVOURS
from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.reading.gcode.flavours import FLAVOURS, Flavour
from pkm_post.reading.gcode.guess import guessed_flavour
from pkm_post.reading.gcode.options import DWELL_UNITS, FLAVOUR_NAMES
from pkm_post.reading.gcode.scan import scan

ANY = Tool(0, "any", 6.0, 0.0, 50.0)
START = "G21 F100 S900\nG0 X0 Y0 Z50\n"


def taken(text, **options):
    return read(START + text, "part.nc", ReadOptions(default_tool=ANY, **options))


def fanuc(text, **options):
    program, faults = taken(text, flavour="fanuc", **options)
    assert program is not None, [str(fault) for fault in faults]
    return program


def codes(text, **options):
    """The codes of the faults, but for the warning about numbers without a point."""
    return [fault.code for fault in taken(text, **options)[1] if fault.code != "G214"]


def moves(program):
    """Kind and place of each row that goes elsewhere, after the first."""
    rows = np.flatnonzero(np.any(np.diff(program.position, axis=0) != 0, axis=1)) + 1
    return [(int(program.kind[row]), *program.position[row].tolist()) for row in rows]


R, L = int(Kind.RAPID), int(Kind.LINE)


def test_the_names_are_the_same_everywhere():
    assert tuple(FLAVOURS) == FLAVOUR_NAMES
    assert reading.FLAVOUR_NAMES == GCODE_FLAVOURS == (*FLAVOUR_NAMES, "siemens")
    assert {flavour.dwell_unit for flavour in FLAVOURS.values()} <= set(DWELL_UNITS)


def test_each_difference_has_a_row_in_the_documentation():
    text = (Path(__file__).parents[3] / "docs" / "g-code.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \|.*\|.*\|.*\[.*\].*\|$", text, re.MULTILINE)
    differ = [
        field
        for field in Flavour._fields
        if field not in ("name", "title") and len({repr(getattr(flavour, field)) for flavour in FLAVOURS.values()}) > 1
    ]
    assert rows == differ


@pytest.mark.parametrize(
    "codes, fanucs, linuxcncs",
    [
        ("G92 X5. Y5.\nG52 X1.\n", (6, 5), (11, 5)),
        ("G92 X5. Y5.\nG52 X1.\nG52 X0. Y0.\n", (5, 5), (10, 10)),
        ("G52 X1. Y1.\nG92 X5.\nG52 X0. Y0.\n", (5, 10), (10, 10)),
        ("G52 X1.\nG92 X5. Y5.\nG52 X2. Y3.\nG92.1 X0\nG52 Y0.\n", (10, 5), None),
        ("G92 X5. Y5.\nG52 X1. Y1.\nG92.1\nG52 X2.\n", (12, 10), (12, 10)),
    ],
)
def test_local_coordinates_and_those_of_g92(codes, fanucs, linuxcncs):
    """[Fanuc] G52 is a system within that of G92, which ends it in its axes; in LinuxCNC they share one offset."""
    text = f"G0 X0. Y0. Z0.\n{codes}X10. Y10.\n"
    for flavour, place in (("fanuc", fanucs), ("rs274", linuxcncs)):
        if place is not None:
            program, _ = read(text, "part.nc", ReadOptions(default_tool=ANY, flavour=flavour))
            assert program.position[-1, :2].tolist() == list(place), flavour


# Coordinate system rotation: codes for reference points and coordinate systems are forbidden in it [Fanuc, Mach4]


@pytest.mark.parametrize(
    "block",
    [
        *(
            "G51.1 X5.",
            "G50.1 X0",
            "G52 X5.",
            "G54",
            "G55",
            "G54.1 P1",
            "G92 X5.",
            "G92.1",
            "G18",
            "G28 X0",
            "G91 G28 X0 Y0 Z0",
            "G30 Y0",
        ),
        *("G53 X0", "G53 G0 Y1. Z5.", "G10 L2 P1 X5.", "G91 G68 X0 Y0 R15."),
    ],
)
def test_codes_within_a_rotation_are_refused_by_name(block):
    text = f"G0 X1. Y2. Z30.\nG68 X0. Y0. R30.\nX3. Y4.\n{block}\nG69\nM30\n"
    _, faults = read(text, "part.ngc", ReadOptions(flavour="fanuc", machine_zero=(0.0, 0.0, 100.0)))
    code = block if "G54.1" in block else next(word for word in block.split() if word not in ("G91", "G0"))
    assert [(fault.code, fault.place.line, fault.found) for fault in faults] == [("G438", 4, f"{code} within G68")]


@pytest.mark.parametrize("block", ["G17", "G28 Z0", "G91 G28 Z0", "G53 Z5.", "G69 G54", "G69\nG55", "G69\nG28 X0",
                                   "G68 X0 Y0 R15.", "G69\nG91 G68 X0 Y0 R15.\nG90"])  # fmt: skip
def test_what_no_rotation_turns_and_what_comes_after_it_is_read(block):
    text = f"G0 X1. Y2. Z30.\nG68 X0. Y0. R30.\nX3. Y4.\n{block}\nG69\nM30\n"
    assert "G438" not in codes(text, flavour="fanuc", machine_zero=(0.0, 0.0, 100.0))


# G80: 13.1 canned cycle. The cycles are group 09, the motions group 01


def test_after_g80_the_motion_before_the_cycle_is_in_force():
    cycle = "G98 G81 X10 Z-5 R2\nG80\n"
    assert moves(fanuc(f"{cycle}Z60\n"))[-1] == (R, 10, 0, 60)
    assert moves(fanuc(f"G1 X5\n{cycle}Z60\n"))[-1] == (L, 10, 0, 60)
    assert codes(f"{cycle}Z60\n", flavour="rs274") == ["G439"]


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_g0_beside_g80_is_in_force_in_every_flavour(flavour):
    program, _ = taken("G0 G17 G40 G80 G90\nX1\nG80 G1 X2\nX3\n", flavour=flavour)
    assert moves(program) == [(R, 1, 0, 50), (L, 2, 0, 50), (L, 3, 0, 50)]


def test_without_a_motion_before_g80_there_is_none_after_it():
    program, faults = read("G80\nX1. Y1. Z1.\nM30\n", "part.nc", ReadOptions(default_tool=ANY, flavour="fanuc"))
    assert (program, [fault.code for fault in faults]) == (None, ["G439"])


# cycles: 13.1 drilling data are held until the cycle is cancelled; K0 stores them


def test_the_words_of_a_cycle_hold_for_the_next_one():
    text = "G99 G81 X10 Z-5 R2\nG82 X20 P50\nG80\n"
    program = fanuc(text)
    assert moves(program) == [
        (R, 10, 0, 50), (R, 10, 0, 2), (L, 10, 0, -5), (R, 10, 0, 2),
        (R, 20, 0, 2), (L, 20, 0, -5), (R, 20, 0, 2),
    ]  # fmt: skip
    assert [event.value for event in program.events if event.kind is EventKind.DWELL] == [0.05]
    assert codes(text, flavour="rs274") == ["G405"]


@pytest.mark.parametrize(
    ("flavour", "sides"),
    # [Fanuc] cutter compensation: the number of D lasts, and that of D0 is no offset; rs274: D0 is the tool's own
    [("fanuc", [0, 2, -2, 0, 2, 0, 0, 0]), ("rs274", [0, 2, -5, 0, 5, 0, 5, 0])],
)
def test_the_number_of_the_cutter_compensation(flavour, sides):
    text = "G21 G90 F100\nT5 M6\nG0 X0 Y0 Z5\nG41 D2 G1 X10 Y10\nG42 X20\nG40 X30\nG41 X40\nG40 X50\nG41 D0 X60\n"
    tools = {number: Tool(number, "", 2.0 * number, 0.0, 100.0) for number in (2, 5)}
    program, _ = read(text + "G40 X70\nM30\n", "part.nc", ReadOptions(flavour=flavour, tools=tools))
    assert program.side_offset.tolist() == sides


@pytest.mark.parametrize(("flavour", "heights"), [("fanuc", [5, 2, 6, 3]), ("rs274", [5, 2, 6, 6])])
def test_the_number_of_the_length_offset(flavour, heights):
    """[Fanuc] custom macro, #4111: H is modal, as D is. Tool 5 is 3 mm longer than the offset of H2."""
    text = "G21 G90\nT5 M6\nG0 X0 Y0 Z5\nG43 H2 Z5\nG49 Z6\nG43 Z6\nM30\n"
    tools = {number: Tool(number, "", 2.0, 0.0, 100.0 + number) for number in (2, 5)}
    program, _ = read(text, "part.nc", ReadOptions(flavour=flavour, tools=tools))
    assert program.position[:, 2].tolist() == heights


def test_a_cycle_that_dwells_needs_no_p():
    for code in ("G82", "G86", "G89"):
        assert not [event for event in fanuc(f"M3\n{code} X1 Z-1 R1\n").events if event.kind is EventKind.DWELL]
        assert codes(f"M3\n{code} X1 Z-1 R1\n", flavour="rs274") == ["G405"]


def test_g89_feeds_out_to_r_and_goes_on_rapidly():
    text = "G98 G89 X1 Z-1 R1 P{}\n"
    assert moves(fanuc(text.format(100)))[-2:] == [(L, 1, 0, 1), (R, 1, 0, 50)]
    program, _ = taken(text.format("0.1"), flavour="rs274")
    assert moves(program)[-1] == (L, 1, 0, 50)


@pytest.mark.parametrize("word", ["L0", "K0"])
def test_a_cycle_repeated_no_times_stores_its_words(word):
    program = fanuc(f"G99 G82 R2 Z-5 P200 F80 {word}\nX10\nG80\n")
    assert moves(program) == [(R, 10, 0, 50), (R, 10, 0, 2), (L, 10, 0, -5), (R, 10, 0, 2)]
    assert [event.value for event in program.events if event.kind is EventKind.DWELL] == [0.2]
    assert codes(f"G81 R2 Z-5 {word}\n", flavour="rs274") == ["G418"]
    assert codes(f"G81 X5 R2 Z-5 {word}\n", flavour="fanuc") == ["G418"]


def test_r_with_g91_is_from_the_initial_level_in_every_flavour():
    for flavour in FLAVOURS:
        program, _ = taken("G91 G99 G81 X10 Z-20 R-48\nX10\n", flavour=flavour)
        assert moves(program)[1:3] == [(R, 10, 0, 2), (L, 10, 0, -18)]
        assert moves(program)[4:6] == [(R, 20, 0, 2), (L, 20, 0, -18)]


# dwells: 5.x G04: P in ms without a point, X in s


def test_dwells_are_in_ms_and_x_of_g4_in_s():
    program = fanuc("G4 P500\nG4 X1.5\nG1 X1\n")
    assert [event.value for event in program.events if event.kind is EventKind.DWELL] == [0.5, 1.5]
    assert moves(program) == [(L, 1, 0, 50)]
    assert codes("G4 P0.5\n", flavour="fanuc") == ["G427"]
    assert codes("G4 P0.5\n", flavour="fanuc", dwell_unit="s") == []
    assert codes("G4 X1.5\n", flavour="rs274") == ["G405"]


# places of the machine: 6.x G28 and G30, 7.1 G53


ZERO = (5.0, 6.0, 300.0)


@pytest.mark.parametrize(
    ("block", "places"),
    [
        ("G91 G28 Z0", [(R, 0, 0, 300)]),
        ("G0 G28 Z60", [(R, 0, 0, 60), (R, 0, 0, 300)]),
        ("G28 X0 Y0", [(R, 5, 6, 50)]),
        ("G30 P2 Z50", [(R, 0, 0, 300)]),
        ("G1 G53 Z-10", [(R, 0, 0, 290)]),
        ("G53 X1 Y-1", [(R, 6, 5, 50)]),
    ],
)
def test_places_of_the_machine(block, places):
    assert moves(fanuc(f"{block}\n", machine_zero=ZERO)) == places
    assert codes(f"{block}\n", flavour="fanuc") in (["G413"], ["G412"])


def test_the_reference_point_after_cycles_that_followed_an_arc():
    program, _ = taken("G0 X0 Y0 Z10\nG2 X4 Y0 R2 F100\nG80 G28 Z60\n", flavour="fanuc", machine_zero=ZERO)
    assert moves(program)[-2:] == [(R, 4, 0, 60), (R, 4, 0, 300)]


def test_g53_takes_the_motion_in_force_in_rs274():
    program, _ = taken("G1 G53 Z-10\n", flavour="rs274", machine_zero=ZERO)
    assert moves(program) == [(L, 0, 0, 290)]
    assert codes("G0 G28 Z0\n", flavour="rs274", machine_zero=ZERO) == ["G407"]


def test_a_third_reference_point_is_not_known():
    assert codes("G30 P3 Z0\n", flavour="fanuc", machine_zero=ZERO) == ["G413"]


def test_the_way_to_the_reference_point_uses_no_work_offset():
    text = "G21\nG91 G28 Z0\nG90 G154 P7\nG0 X1. Y2. Z3.\nM30\n"
    program, _ = read(text, "part.nc", ReadOptions(default_tool=ANY, flavour="fanuc", machine_zero=ZERO))
    assert program.position[-1].tolist() == [1, 2, 3]
    text = text.replace("M30", "G54.1 P8\nX5.\nM30")
    faults = read(text, "part.nc", ReadOptions(default_tool=ANY, flavour="fanuc", machine_zero=ZERO))[1]
    assert [(fault.code, fault.found) for fault in faults] == [("G412", "G54.1 P8")]


# codes that change nothing, and requests


def test_ends_of_what_was_never_begun_change_nothing():
    text = "G15 G50 G69 G49 G67\nG13.1\nG22\nG25\nM29 S100\nG1 X1\n"
    assert moves(fanuc(text)) == [(L, 1, 0, 50)]
    assert codes("G15\n", flavour="rs274") == ["G402"]


@pytest.mark.parametrize(("code", "fault"), [("G113", "G402"), ("G150", "G402")])
def test_codes_that_another_make_moves_by_are_not_ends_of_something(code, fault):
    # Ends of modes on Fanuc's controls; a work offset and the milling of a pocket on those of Haas.
    assert codes(f"{code}\n", flavour="fanuc") == [fault]


@pytest.mark.parametrize("flavour", ["fanuc", "rs274"])
@pytest.mark.parametrize("code", ["M97", "M198"])
def test_calls_that_are_not_read_are_never_left_out(code, flavour):
    assert codes(f"{code} P100\n", flavour=flavour, left_out=(code,)) == ["G402"]


def test_requests_for_smoothing_are_reported():
    program = fanuc("G5.1 Q1\nG1 X1\nG5.1 Q0\nG5 P10000\nG187 P2 E0.02\nG8 P1\nG61.1\nG5.1 Q1\nG5.1 Q0\nX2\n")
    assert moves(program) == [(L, 1, 0, 50), (L, 2, 0, 50)]
    assert not program.exact_stop.any()
    assert [line.split()[0] for line in program.reading[1:]] == ["G5", "G5.1", "G8", "G61.1", "G187"]
    assert "(lines 3, 5, 10 and 1 more)" in program.reading[2]


def test_codes_are_left_out_as_chosen_and_named():
    text = "M21\nM46 P2 Q1\nG1 X1 M21\nG211 P1\n"
    assert codes(text, flavour="fanuc") == ["G401"] * 4
    program = fanuc(text, left_out=("M21", "M46", "G211"))
    assert moves(program) == [(L, 1, 0, 50)]
    assert program.reading[1:] == (
        "G211, left out as chosen (line 6)",
        "M21, left out as chosen (lines 3, 5)",
        "M46, left out as chosen (line 4)",
    )


@pytest.mark.parametrize(
    ("block", "code", "fault"),
    [("G1 X1", "G1", None), ("G60 P2", "G60", "G402"), ("G84 X1 Z-1 R1", "G84", "G425"), ("G211 X1", "G211", "G401")],
)
def test_nothing_that_is_understood_or_moves_the_tool_is_left_out(block, code, fault):
    assert codes(f"{block}\n", flavour="fanuc", left_out=(code,)) == ([fault] if fault else [])


@pytest.mark.parametrize("flavour", FLAVOUR_NAMES)
@pytest.mark.parametrize(
    "code", ["G12", "G41.2", "G54.2", "G70", "G71", "G101", "G110", "G129", "G254", "G60", "G31", "G12.1", "G68.3"]
)
def test_codes_that_move_the_tool_or_change_other_blocks_are_not_left_out(code, flavour):
    """Of Fanuc's controls, and of Haas's: G110 to G129 are those of L20 P1 to P20 of its G10."""
    assert codes(f"{code} D1\n", flavour=flavour, left_out=(code,)) == ["G402"]


@pytest.mark.parametrize(
    ("code", "other", "understood"),
    [
        *((code, "rs274", "fanuc") for code in ("G54.1 P1", "G154 P1", "G53.1", "G234")),
        *((code, "fanuc", "rs274") for code in ("G28.1", "G30.1", "G43.2 H1", "G92.2", "G92.3")),
    ],
)
def test_codes_of_the_other_flavour_name_it(code, other, understood):
    _, (*_, fault) = taken(f"{code}\n", flavour=other, left_out=(code.split()[0],))
    assert fault.code == "G402" and fault.found.endswith(f": it is understood with --flavour {understood}")


# programs


def test_subprograms_are_counted_in_p():
    text = "M98 P30020\nM30\nO20\nG91 G1 X1\nG90\nM99\n"
    assert fanuc(text).position[-1].tolist() == [3, 0, 50]
    assert codes(text, flavour="rs274") == ["G309"]


def test_m99_ends_the_main_program_and_it_is_carried_out_once():
    program = fanuc("G1 X1\nM99\nX2\n", needs_end=True)
    assert moves(program) == [(L, 1, 0, 50)]
    assert "M99" in program.reading[-1]
    assert codes("G1 X1\nM99\n", flavour="rs274") == ["G312"]


def test_another_program_is_only_entered_by_a_call():
    assert codes("M98 P7\nO7\nG1 X5\nM99\n", flavour="fanuc", needs_end=True) == ["G430"]
    assert codes("M98 P7\nM30\nO7\nG1 X5\nO8\nM99\n", flavour="fanuc") == ["G308"]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("G1 X10. Y0 Z-0\nX.5 (X5) ;X5\n", []),
        ("G1 X10\n", [(3, 4, "X10")]),
        ("G1 X1.\nY 20 I 3.5\nz-007\n", [(4, 1, "Y 20, and 1 more like it")]),
        ("G4 P1\nN10 G1 X1.5 Y2. F300\n", []),
        ("G83 X1. Z-9. R2 Q5000\nG80\n", [(3, 14, "R2, and 1 more like it")]),
        ("G73 X1. Z-9. R2. Q5000\nG80\nG5.1 Q1\n", [(3, 18, "Q5000")]),
        ("G68 X0 Y0 R90\nG2 X1. Y1. R5\n", [(3, 11, "R90, and 1 more like it")]),
    ],
)
def test_lengths_without_a_point_are_reported(text, found):
    text = text.replace("I 3.5", "")
    program, faults = read("G21 F100\nG0 X0 Y0 Z50.\n" + text, "p", ReadOptions(default_tool=ANY, flavour="fanuc"))
    assert [(fault.place.line, fault.place.column, fault.found) for fault in faults] == found
    assert program is not None
    assert read("G21\nG0 X1 Y1 Z1\n", "p", ReadOptions(default_tool=ANY))[1] == ()


@pytest.mark.parametrize("flavour", ["rs274", "fanuc"])
def test_a_name_may_stand_for_the_number_of_the_program(flavour):
    """rs274 ignores it anywhere; behind the first block it may be a call without its keyword."""
    program, faults = read(f"O<PART-1>\n{START}M30\n", "part.nc", ReadOptions(default_tool=ANY, flavour=flavour))
    assert program is not None and {fault.code for fault in faults} <= {"G214"}


def test_a_colon_is_an_o():
    assert fanuc("M98 P0020020\nM30\n:20\nG91 G1 X1\nG90\nM99\n").position[-1].tolist() == [2, 0, 50]
    program, _ = read(":1001\nG21\nG0 X1. Y1. Z1.\nM30\n", "p", ReadOptions(default_tool=ANY))
    assert program.reading[0] == "flavour fanuc, by O1001 in line 1"


# the guess


@pytest.mark.parametrize(
    ("text", "name", "evidence"),
    [
        ("G0 X1\nM2", "rs274", ()),
        ("O1001\nG0 X1\nM30", "fanuc", ("O1001 in line 1",)),
        ("<PART-1.A>\nG0 X1\nM30", "fanuc", ("<PART-1.A> in line 1",)),
        ("G0 X1\nG5.1 Q1\nM30", "fanuc", ("G5.1 in line 2",)),
        ("G0 X1.\nG92.1 X0 Y0\nM30", "fanuc", ("G92.1 X in line 2",)),
        ("G5.1 X1 Y1 I1 J1", "rs274", ()),
        ("G81 X1 Z-1 R1\nG80\nZ5", "fanuc", ("axis words after G80 in line 3",)),
        ("G81 X1 Z-1 R1\nG0 G80\nZ5", "rs274", ()),
        ("G80\nG0 Z5\nG80 G28 Z0", "rs274", ()),
        ("G4 X1", "fanuc", ("G4 X in line 1",)),
        ("G4 P.001 G0 X1", "rs274", ()),
        ("G81 X1 Z-1 R1 K3", "fanuc", ("K in a cycle in line 1",)),
        ("o10 sub\no10 endsub\n#<a>=1\nG64 P0.1", "rs274", ("O10 sub in line 1", "#<a> in line 3", "G64 P in line 4")),
        ("O<a.b> sub\nG1 X1\nO<a.b> endsub", "rs274", ("O<a.b> sub in line 1",)),
        ("O<PART-1>\nG8\nG1 X1", "rs274", ()),
        ("G90 G54 G64 G50 G17\nG1 X1", "rs274", ()),  # PathPilot's, whose dwells are in seconds
        ("G00 G49 G40.1 G17 G80 G50 G90\nG1 X1", "fanuc", ("G40.1 in line 1",)),  # the heading of Mach3's wizards
        ("G8 P1\nG1 X1", "fanuc", ("G8 P in line 1",)),
        ("G92.2\nO1\nG15\nG1 X1", "fanuc", ("O1 in line 2", "G15 in line 3")),
    ],
)
def test_the_flavour_is_guessed_by_what_only_one_has(text, name, evidence):
    guess = guessed_flavour(scan(text, "part.nc")[0])
    assert (guess.flavour.name, guess.evidence) == (name, evidence)


def test_the_report_names_the_flavour_and_its_evidence():
    assert taken("M2\n")[0].reading == ("flavour rs274: nothing in the program speaks for another",)
    assert fanuc("M30\n").reading == ("flavour fanuc, as chosen",)
    program, _ = taken("G64 P0.1\nG15\nG50\nG22\nG5.1 Q1\nG1 X1\nM2\n")
    assert program.reading[0] == ("flavour fanuc, by G15 in line 4, G5.1 in line 7; although G64 P in line 3")


def test_a_value_that_is_no_flavour_is_refused():
    with pytest.raises(ValueError, match="flavour: expected one of rs274, fanuc, got 'heidenhain'"):
        ReadOptions(flavour="heidenhain")


def test_a_program_of_another_flavour_is_the_same_motion_where_they_agree():
    text = "G17 G90 G1 X1 Y2 F50\nG2 X3 Y2 I1 J0\nG91 G1 X1\nG90 Z5\nG83 X5 Z-3 R1 Q1\n"
    one, other = (taken(text, flavour=flavour)[0] for flavour in FLAVOURS)
    np.testing.assert_array_equal(one.position, other.position)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("G17 G3 X1. Y1. R2. F60.\nG53 Z40. I1.\nM30\n", "G404"),  # G53 is rapid, and takes no word of the arc in force
        ("G17 G3 X1. Y1. R2. F60.\nG53 Z40. R1.\nM30\n", "G404"),
        ("G16\nG1 X10. Y30. @1 F60.\nG15\nM30\n", "G407"),
        ("G1 X1. F60. M8 M9\nM30\n", "G403"),
        ("G1 X1. F60. M9 M7\nM30\n", "G403"),
    ],
)
def test_words_that_would_have_no_effect_are_faults(text, fault):
    zero = (0.0, 0.0, 0.0)
    assert codes(text, flavour="fanuc", machine_zero=zero) == [fault]
    assert codes("G1 X1. F60. M8 M7\nG53 Z40.\nM30\n", flavour="fanuc", machine_zero=zero) == []


@pytest.mark.parametrize(
    ("turn", "flavour", "codes"),
    [
        ("G68 R90.", "rs274", ["G405"]),
        ("G68 R90.", "fanuc", []),
        ("G68 X1. R90.", "rs274", ["G405"]),
        ("G68 X1. R90.", "fanuc", ["G405"]),
        ("X0. Y0.\nG68 R90.", "rs274", []),
        ("Y0.\nG68 X1. R90.", "fanuc", []),
        ("G68 A0 B0 R90.", "rs274", ["G404"]),
        ("G68 A1. B2. R90.", "fanuc", ["G404"]),
    ],
)
def test_a_turn_without_a_centre_is_read_where_controls_agree(turn, flavour, codes):
    """About the tool for Fanuc, about the origin for EdingCNC and Mach3, whose centre is A and B."""
    text = f"G0 X1. Y2. Z3.\n{turn}\nX4. Y2.\nG69\nM30\n"
    program, faults = read(text, "part.nc", ReadOptions(flavour=flavour))
    assert [fault.code for fault in faults if fault.code != "G214"] == codes
    if turn == "G68 R90." and not codes:
        np.testing.assert_allclose(program.position[-1], (1, 5, 3), atol=1e-9)


@pytest.mark.parametrize("code", ["G68 X0 Y0 R30.", "G52 Y1.", "G55", "G92 Y1.", "G91 G28 X0", "G53 X0"])
def test_what_controls_forbid_within_a_mirror_image_is_refused(code):
    """A rotation in a mirror image along one axis turns the other way round: SINUMERIK, ISO Milling, G51.1."""
    zero = {"flavour": "fanuc", "machine_zero": (0.0, 0.0, 100.0)}
    text = f"G51.1 X5.\n{code}\nG69 G90\nG50.1 X0\nG1 X1. Y1. Z1.\nM30\n"
    assert codes(text, **zero)[:1] == ["G438"]
    assert "G438" not in codes(text.replace("X5.\n", "X5.\nG50.1 X0\n"), **zero)


def test_along_other_axes_a_mirror_image_changes_nothing_of_a_place_of_the_machine():
    text = "G51.1 X5.\nG91 G28 Z0\nG90 G53 Y0\nG50.1 X0\nG1 X1. Y1. Z1.\nM30\n"
    assert codes(text, flavour="fanuc", machine_zero=(0.0, 0.0, 100.0)) == []


@pytest.mark.parametrize("flavour", ["fanuc", "rs274"])
def test_a_program_that_is_not_read_is_a_warning(flavour):
    """[Fanuc] program configuration: a file may hold several programs, and each is run by its number."""
    one, sub = "O1\nG21\nG0 X1. Y1. Z9.\n{}M30\n", "O7\nG0 Z10.\nM99\n"
    text = one.format("M98 P7\n") + sub + "O8\nG0 X5.\nM99\nO2\n(other)\nG0 X2.\nM30\nO3\nG0 X3.\nM2\n"
    program, found = read(text, "p", ReadOptions(default_tool=ANY, flavour=flavour))
    assert program.position[-1].tolist() == [1, 1, 10]
    assert [(str(fault.code), fault.place.line, fault.found) for fault in found] == [
        ("G215", 12, "O2"), ("G215", 16, "O3")
    ]  # fmt: skip
    assert read(one.format("") + sub, "p", ReadOptions(default_tool=ANY, flavour=flavour))[1] == ()
