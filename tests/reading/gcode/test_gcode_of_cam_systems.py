# SPDX-License-Identifier: LGPL-2.1-or-later
"""What programs of CAM systems for controls of Fanuc's kind have in their headings, cycles and ends.

Made here after the form of posts for Mastercam, Fusion and others; the pecks are from the manual of Haas mills, G83.
"""

import numpy as np
import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)
ZERO = (0.0, 100.0, 300.0)


def taken(text, **options):
    return read(text, "part.nc", ReadOptions(default_tool=ANY, machine_zero=ZERO, **options))


def ends(text, **options):
    program, faults = taken(text, **options)
    assert program is not None, [str(fault) for fault in faults]
    rows = np.append(0, np.flatnonzero(np.any(np.diff(program.position, axis=0), axis=1)) + 1)
    return program.position[rows]


HEADED = """O8651( WEDGE )
( DATE - NOV. 15 )
G21
G0 G17 G40 G80 G90 G94 G98
/M31
G0 G28 G91 Z0.
T17 M6
M01
G0 G90 G54 X-5. Y4. B0. A0. S6000 M3
T1
G43 H17 Z10. /M8
G83 G99 Z-6. R2. I4. J1. K2. F80.
X5.
G80 /M9
M5
G0 G28 G91 Z0.
G0 G28 Y0.
M30
%
"""


def test_a_whole_program_is_read():
    program, faults = taken(HEADED, left_out=("M31",), needs_end=True)
    assert faults == ()
    assert program.reading == (
        "flavour fanuc, by O8651 in line 1, K in a cycle in line 12",
        "M31, left out as chosen (line 5)",
    )
    bottoms = ends(HEADED, left_out=("M31",))
    assert bottoms[-2:].tolist() == [[5, 4, 300], [5, 100, 300]]


def test_pecks_grow_smaller_down_to_k():
    # R 2, pecks of 4, 3, 2, 2 and so on: to -2, -5, -6
    drilled = ends(HEADED, left_out=("M31",))
    depths = drilled[(drilled[:, 0] == -5) & (drilled[:, 2] < 2), 2].round(9).tolist()
    assert depths == [-2, -2 + 0.254, -5, -5 + 0.254, -6]


@pytest.mark.parametrize(
    ("words", "code"), [("I4. J1.", "G418"), ("I4. J1. K5.", "G418"), ("I4.", None), ("Q4. K2", None)]
)
def test_words_of_pecks(words, code):
    text = f"G21\nG0 X0 Y0 Z10.\nG83 G99 X1. Z-6. R2. {words} F80.\n"
    assert [fault.code for fault in taken(text, flavour="fanuc")[1]] == ([code] if code else [])
    assert taken(text.replace(words, "I4. Q4"), flavour="rs274")[1][0].code == "G404"


def test_what_follows_a_stroke_within_a_block_is_left_out_as_a_deleted_block_is():
    text = "G21\nG0 X0 Y0 Z10\nG0 X1 /Y2\n/X3\nZ[4/2] /Y7\n"
    assert ends(text)[-1].tolist() == [3, 7, 2]
    assert ends(text, block_delete=True)[-1].tolist() == [1, 0, 2]
    assert [fault.code for fault in taken("G0 X1 /Y2 X3\n")[1]] == ["G202"]


@pytest.mark.parametrize(
    "skipped, lines, place",
    [
        (False, [1, 2, 3, 4, 5], (5, 7, 8)),
        (True, [1, 5], (5, 0, 0)),
        ((1,), [1, 2, 5], (5, 7, 8)),
        ((2,), [1, 3, 4, 5], (5, 7, 4)),
        ((3,), [1, 2, 4, 5], (5, 0, 4)),
        ((4, 9), [1, 2, 3, 4, 5], (5, 7, 8)),
    ],
)
def test_each_switch_leaves_out_what_stands_behind_its_number(skipped, lines, place):
    text = "G0 X0 Y0 Z0\n/2 G0 X1\n/1/3 Y3\n/ Z4\nX5 /3 Y7 /2 Z[16/2]\n"
    program, _ = taken(text, block_delete=skipped)
    assert program.line.tolist() == lines and tuple(program.position[-1].tolist()) == place


def test_arguments_behind_a_switch_within_a_block_are_left_out():
    text = "O1\nG65 P2 X1 /2 Y5 /3 Z7\nM30\nO2\nG0 X#24 Y[#25+1] Z[#26+1]\nM99\n"
    assert ends(text, block_delete=(3,), flavour="fanuc")[-1].tolist() == [1, 6, 1]
    assert ends(text, block_delete=(2,), flavour="fanuc")[-1].tolist() == [1, 1, 1]


def test_rotary_words_of_zero_leave_the_tool_upright():
    assert ends("G0 X1 Y2 Z3 A0. B0.\nC0\nX2\n")[-1].tolist() == [2, 2, 3]
    assert [fault.code for fault in taken("G0 X1 Y2 Z3 A0. B1.\n")[1]] == ["G414"]


def test_the_reference_point_of_rotary_axes_moves_nothing():
    assert ends("G0 X1 Y2 Z3\nG91 G28 B0.\nG28 A0 Z0\n")[-1].tolist() == [1, 2, 300]


@pytest.mark.parametrize("notation", ["AC", "BC", "AB", "RPY"])
@pytest.mark.parametrize("flavour", ["fanuc", "rs274"])
def test_the_reference_point_of_rotary_axes_of_the_notation_is_that_of_an_upright_tool(notation, flavour):
    first, last = notation[0].replace("R", "A"), notation[1].replace("P", "B")
    options = {"axis_words": notation, "flavour": flavour}
    way = ends(f"G0 X1 Y2 Z3\nG28 {first}0\nG91 G28 Z0 {first}0. {last}0.\nG90 G43.4 H1 G0 X5\n", **options)
    assert way[-2:].tolist() == [[1, 2, 300], [5, 2, 300]]
    for before, code in ((f"{last}90.", f"G28 {first}0"), (f"{last}0", f"G30 {first}5.")):
        _, faults = taken(f"G43.4 H1 G0 X1 Y2 Z3 {before}\n{code}\n", **options)
        found = f"{code.split()[1].rstrip('.')} of {code[:3]}, a way to a place that is not known: turn with G0"
        assert [(each.code, each.found) for each in faults if each.code != "G214"] == [("G404", found)]


def test_a_hole_of_an_upright_tool_outside_g17_is_refused_where_a_parameter_of_the_control_decides():
    text = "G0 X1. Y2. Z3. F100 S500 M3\nG18 G81 X5. Y-5. Z3. R2.\nG80\nM5\n"
    program, faults = taken(text, flavour="fanuc")
    assert program is None
    found = "G18, where parameter 5101#0 may say Z: write G17"
    assert [(each.code, each.found) for each in faults] == [("G429", found)]
    assert ends(text, flavour="rs274")[-2:].tolist() == [[5, -5, 3], [5, 2, 3]]
    along_y = "G43.5 H1 G0 X1. Y2. Z3. I0 J1 K0 F100 S500 M3\n" + text.split("\n", 1)[1]
    assert ends(along_y, flavour="fanuc", axis_words="vector")[-2:].tolist() == [[5, -5, 3], [5, 2, 3]]


TILTED = """G21
G0 G54 X0 Y0 Z100 A0. C0. S900 M3
G0 A30. C90.
G0 X9
G43.4 H1 X5. Y6. Z50.
G1 Z0 F200
G0 Z50
G49
G91 G28 Z0
G90 G0 A0 C0 X7
Y1
Z100
X8
"""


def test_rapid_moves_may_tilt_the_tool_before_the_control_of_its_tip():
    program, faults = taken(TILTED, axis_words="AC", flavour="fanuc")
    assert [(fault.code, fault.place.line) for fault in faults] == [("G214", 2), ("G431", 3)]
    assert program.line.tolist() == [2, 5, 6, 7, 9, 9, 12, 13]
    np.testing.assert_allclose(program.position[[1, -2, -1]], [[5, 6, 50], [7, 1, 100], [8, 1, 100]])
    np.testing.assert_allclose(
        program.tool_axis[[0, 1, -1]], [[0, 0, 1], [0.5, 0, np.sqrt(0.75)], [0, 0, 1]], atol=1e-9
    )


@pytest.mark.parametrize("flavour", ["fanuc", "rs274"])
def test_a_tilted_tool_may_go_to_the_machine_zero_without_the_control_of_its_tip(flavour):
    options = {"axis_words": "AC", "flavour": flavour}
    program, _ = taken(TILTED.replace("G91 G28 Z0\nG90 ", "G53 G0 Z0\n"), **options)
    assert program.line.tolist() == [2, 5, 6, 7, 9, 12, 13]
    np.testing.assert_allclose(program.position[[3, 4, 5]], [[5, 6, 50], [5, 6, 300], [7, 1, 100]])
    np.testing.assert_allclose(program.tool_axis[4], [0.5, 0, np.sqrt(0.75)], atol=1e-9)
    _, faults = taken(TILTED.replace("G91 G28 Z0\n", "G53 G0 Z0\nG1 X2\n"), **options)
    assert ("G424", 10) in [(each.code, each.place.line) for each in faults]


def test_turns_of_an_arc_are_linuxcnc_s():
    text = "G0 X0. Y0. Z3.\nG2 X0. Y0. Z0. I5. P2 F100\n"
    assert taken(text, flavour="rs274")[0].position[-2:, 2].tolist() == [1.5, 0]
    program, faults = taken(text, flavour="fanuc")
    assert program is None and [(each.code, each.found) for each in faults] == [("G404", "P2")]


def test_cuts_do_not_tilt_it_there():
    text = TILTED.replace("G0 A30. C90.", "G1 F100 A30. C90.")
    codes = [fault.code for fault in taken(text, axis_words="AC", flavour="fanuc")[1]]
    assert codes[1] == "G414"


def test_cuts_need_all_of_the_place():
    faults = taken(TILTED.replace("X5. Y6. Z50.", "X5. Z50."), axis_words="AC", flavour="fanuc")[1]
    assert [(fault.code, fault.place.line) for fault in faults] == [("G214", 2), ("G431", 3), ("G416", 6)]


VECTRIC = """( Engraving )
G00G21G17G90G40G49G80
G71G91.1
T1M06
G00G43Z20.000H1
S16000M03
G94
X0.000Y0.000F2032.0
G1Z-1.000F762.0
G3X10.000Y0.000I5.000J0.000F2032.0
M30
"""


@pytest.mark.parametrize("flavour", ["rs274", "fanuc", None])
def test_a_second_code_of_the_unit_in_force_changes_nothing(flavour):
    """The heading of Vectric's programs for Mach3, whose G70 and G71 are G20 and G21."""
    assert ends(VECTRIC, flavour=flavour)[-2:].tolist() == [[0, 0, -1], [10, 0, -1]]
    inches = "G20 G70 G90\nG0 X1. Y0. Z1.\nG71\nM30\n"
    program, faults = taken(inches, flavour=flavour)
    assert program is None and [(each.code, each.place.line) for each in faults] == [("G402", 3)]
    assert ends(inches.replace("G71\n", ""), flavour=flavour).tolist() == [[25.4, 0, 25.4]]


NX = """%
N0010 G40 G17 G94 G90 {}
N0020 G91 G28 Z0.0
:0030 T01 M06
N0040 G0 G90 X1. Y0. S1000 M03
N0050 G43 Z2. H01
N0060 G1 X3. F250.
N0070 M02
%
"""


@pytest.mark.parametrize("flavour", ["rs274", "fanuc", None])
def test_the_heading_of_nx_has_its_unit_as_in_iso_6983(flavour):
    """Post Builder's default for mills: G70 and G71 alone say the unit, and a colon stands for N."""
    assert ends(NX.format("G71"), flavour=flavour)[-1].tolist() == [3, 0, 2]
    assert ends(NX.format("G70"), unit="inch", flavour=flavour)[-1].tolist() == pytest.approx([76.2, 0, 50.8])
    for unit, code in (("mm", "G70"), ("inch", "G71")):
        assert [str(fault.code) for fault in taken(NX.format(code), unit=unit, flavour=flavour)[1]] == ["G402"]


def test_holes_of_haas_controls_are_no_unit():
    program, (fault,) = taken("G21\nG0 X0. Y0. Z5.\nG71 I5. J0. K90. L4\nM30\n", flavour="fanuc")
    assert program is None and fault.code == "G402"
