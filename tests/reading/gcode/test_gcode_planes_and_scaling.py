# SPDX-License-Identifier: LGPL-2.1-or-later
"""G68.2 with G53.1, and G51: places and directions by other formulas, and what is refused.

The turn of a tilted plane is composed here of three turns by Rodrigues' formula about the axes as they have become;
scaled programs are compared with programs whose numbers a test has scaled itself.
"""

import numpy as np
import pytest

from pkm_post.model import Kind, Tool
from pkm_post.reading.gcode import ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)
HEAD = "O1\nG21 G90 G94 G17\nG0 X0. Y0. Z100.\nG1 F100.\n"


def taken(text, flavour="fanuc", **options):
    return read(HEAD + text, "part.nc", ReadOptions(default_tool=ANY, flavour=flavour, **options))


def codes(text, **options):
    return [(fault.code, fault.place.line - 4) for fault in taken(text, **options)[1]]


def turned(vectors, axis, degrees):
    angle = np.radians(degrees)
    along = np.outer(vectors @ axis, axis)
    return vectors * np.cos(angle) + np.cross(axis, vectors) * np.sin(angle) + along * (1 - np.cos(angle))


def plane_of(i, j, k):
    """The axes of a plane as rows: about Z, about the new X, about the new Z."""
    axes = turned(np.eye(3), np.array([0.0, 0.0, 1.0]), i)
    axes = turned(axes, axes[0], j)
    return turned(axes, axes[2], k)


@pytest.mark.parametrize("angles", [(0, -90, 0), (30, 40, 0), (0, 0, 25), (-120, 15, 200), (10, 20, 30)])
def test_a_tilted_plane_by_euler_angles(angles):
    i, j, k = angles
    moves = "G0 X1. Y2.\nZ30.\nG1 Z-3.\nG2 X1. Y2. I4. J0.\nG0 Z30.\n"
    text = f"G68.2 X10. Y20. Z5. I{i}. J{j}. K{k}.\nG53.1\n{moves}G69\nM30\n"
    program, faults = taken(text)
    assert [fault.code for fault in faults if fault.code != "V131"] == ["G433"]
    axes, origin = plane_of(*angles), np.array([10.0, 20.0, 5.0])
    inside = np.array([[1.0, 2.0, 30.0], [1.0, 2.0, -3.0], [1.0, 2.0, -3.0], [1.0, 2.0, 30.0]])
    assert np.allclose(program.position[1:], origin + inside @ axes, atol=1e-12)
    assert np.allclose(program.tool_axis[1:], axes[2], atol=1e-12)
    arc = int(np.flatnonzero(program.kind == Kind.ARC)[0])
    assert np.allclose(program.arc_centre[arc], origin + np.array([5.0, 2.0, -3.0]) @ axes, atol=1e-12)
    assert np.allclose(program.arc_axis[arc], -axes[2], atol=1e-12)


def test_cycles_drill_along_the_tilted_tool():
    text = "G68.2 X0. Y0. Z0. I0. J-90. K0.\nG53.1\nG0 X0. Y0. Z50.\nG81 X1. Z-5. R2.\nX4.\nG80\nG69\nM30\n"
    program, _ = taken(text)
    bottoms = program.position[1:][program.kind[1:] == Kind.LINE]
    assert np.allclose(bottoms, [[1, -5, 0], [4, -5, 0]], atol=1e-12)  # the Z of the plane is Y


def test_after_the_plane_the_place_is_known_again_with_all_coordinates_and_the_tool_is_upright():
    text = (
        "G68.2 X0. Y0. Z0. I0. J90. K0.\nG53.1\nG0 X0. Y0. Z50.\nG69\nG28 G91 Z0\nG90 B0. C0.\nX5. Y6.\nG1 Z1.\nM30\n"
    )
    program, faults = taken(text, machine_zero=(0.0, 0.0, 300.0))
    assert program.position[-2:].tolist() == [[5.0, 6.0, 300.0], [5.0, 6.0, 1.0]]
    assert program.tool_axis[-2:].tolist() == [[0.0, 0.0, 1.0]] * 2
    assert [(fault.code, fault.place.line) for fault in faults if fault.code == "G443"] == [("G443", 9)]  # G28


def test_a_retract_to_a_known_place_after_the_plane_is_no_warning():
    text = "G68.2 X0. Y0. Z0. I0. J90. K0.\nG53.1\nG0 X0. Y0. Z50.\nG69\nG0 X5. Y6. Z70.\nG28 G91 Z0\nM30\n"
    program, faults = taken(text, machine_zero=(0.0, 0.0, 300.0))
    assert program.position[-2:].tolist() == [[5.0, 6.0, 70.0], [5.0, 6.0, 300.0]]
    assert "G443" not in [fault.code for fault in faults]


PLANE = "G68.2 X0. Y0. Z0. I0. J30. K0.\n"


@pytest.mark.parametrize(
    "axis_words, words", [("AC", "A30. C0."), ("AC", "A-30. C180."), ("BC", "B30. C-90."), ("AC", "A7.")]
)
def test_rotary_words_before_a_plane_are_replaced_by_its_turn(axis_words, words):
    """Posts of Fusion and NX turn the axes before G68.2; G53.1 then puts the tool along Z of the plane [Fanuc]."""
    text = PLANE + "G53.1\nG0 X1. Y2. Z30.\nG1 Z-3.\nG0 Z30.\nG69\nG0 A0. B0. C0.\nX5. Y6. Z7.\nM30\n"
    one, _ = taken(text, axis_words=axis_words)
    other, faults = taken(f"G0 {words}\n{text}", axis_words=axis_words)
    assert other is not None, faults
    count = 6
    for name in ("position", "tool_axis", "kind"):
        assert np.array_equal(getattr(one, name)[-count:], getattr(other, name)[-count:])
    assert np.allclose(other.tool_axis[-4], [0, -0.5, np.sqrt(0.75)])
    assert "G433" in [fault.code for fault in faults]


def test_fusions_way_from_a_plane_to_control_of_the_tip():
    """G69 leaves the tool as it is; both rotary words under G43.4 say how it stands."""
    plane = f"G0 A30. C0.\n{PLANE}G53.1\nG0 X51. Y-18.\nG69\nG43.4 H1\nG0 X51. Y-29. Z14. A30. C0.\n"
    program, faults = taken(f"{plane}G1 Y-20. Z-2.\nM30\n", axis_words="AC")
    assert program is not None, faults
    assert program.position[-1].tolist() == [51.0, -20.0, -2.0]
    assert np.allclose(program.tool_axis[-1], [0, -0.5, np.sqrt(0.75)])


@pytest.mark.parametrize(
    ("words", "found"),
    [("A0.", ["G432"]), ("A0. C0.", []), ("A0.\nC0.", []), ("C0.\nA0.", []), ("A0.\nG43.4 H1\nC0.", [])],
)
@pytest.mark.parametrize("before", ["A0. C0.", "A0."])
def test_a_plane_leaves_the_other_rotary_axis_where_it_turned_it(words, found, before):
    """G53.1 turns C, and A alone does not turn it back, so a later A tilts along an unknown C [Fanuc].

    A program without C is one for a machine without it.
    """
    text = f"G0 {before}\n{PLANE}G53.1\nG0 X1. Y2. Z30.\nG69\nG0 {words}\nG43.4 H1\nX5. Y6. Z70.\nG1 A30. Z9.\nM30\n"
    expected = found if "C" in before + words else []
    assert [code for code, _ in codes(text, axis_words="AC") if code == "G432"] == expected


@pytest.mark.parametrize(("word", "faults"), [("C0.", ["G432"]), ("A0.", [])])
def test_c_alone_does_not_bring_a_tool_upright(word, faults):
    text = f"{PLANE}G53.1\nG0 X1. Y2. Z30.\nG69\nG0 {word}\nX5. Y6. Z70.\nG1 Z1.\nM30\n"
    assert [code for code, _ in codes(text, axis_words="AC") if code == "G432"] == faults


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G53.1\nM30\n", [("G432", 1)]),
        (PLANE + "X1.\nG53.1\nM30\n", [("G432", 2), ("G433", 3)]),
        (PLANE + "G53.1\nG0 X0. Y0. Z1.\nG69\nG1 X1. Y1. Z1.\nM30\n", [("G433", 2), ("G416", 5), ("G432", 5)]),
        (PLANE + "G53.1\nG52 X1.\nM30\n", [("G433", 2), ("G432", 3)]),
        (PLANE + "G53.1\nG68 X0. Y0. R30.\nM30\n", [("G433", 2), ("G432", 3)]),
        ("G68 X0. Y0. R30.\n" + PLANE + "G53.1\nM30\n", [("G432", 2), ("G433", 3)]),
        ("G51.1 X0.\n" + PLANE + "G53.1\nM30\n", [("G432", 2), ("G433", 3)]),
        ("G51.1 X0.\nG50.1\n" + PLANE + "G53.1\nM30\n", [("G433", 4)]),
        ("G68.2 X0. Y0. Z0. I0. J30.\nM30\n", [("G405", 1)]),
        ("G68.2 P1 X0. Y0. Z0. I10. J30. K0.\nG53.1\nM30\n", [("G402", 1), ("G433", 2)]),
        ("G68.2 P2 X0. Y0. Z0. I0. J30. K0.\nG53.1\nM30\n", [("G402", 1), ("G433", 2)]),
        ("G68.2 P2 Q1 X0. Y0. Z0.\nG68.2 P2 Q2 X1.\nG53.1\nM30\n", [("G402", 1), ("G402", 2), ("G433", 3)]),
        ("G68.2 P3 Q1 X0. I1.\nG53.1\nM30\n", [("G402", 1), ("G433", 2)]),
        ("G68.2 P4 X0. Y0. Z0. I0. J30. K0.\nG53.1\nM30\n", [("G402", 1), ("G433", 2)]),
        ("G68.2 P5 X0. Y0. Z0. I0. J30. K0.\nG53.1\nM30\n", [("G406", 1), ("G433", 2)]),
        ("G68.2 X0. Y0. Z0. I0. J30. K0. Q1\nG53.1\nM30\n", [("G404", 1), ("G433", 2)]),
        (PLANE + "G53.1\nG0 X0. Y0.\nG1 Z1.\nM30\n", [("G433", 2), ("G416", 4)]),
    ],
)
def test_where_it_is_not_clear_how_the_tool_stands(text, expected):
    assert codes(text) == expected


@pytest.mark.parametrize(
    ("words", "x", "axis"),
    [
        ("I90.", [1, 0, 0], [0, -1, 0]),
        ("I0. J90. K0.", [0, 0, -1], [1, 0, 0]),
        ("Q321 I0. J0. K90.", [0, 1, 0], [0, 0, 1]),
        ("Q123", [1, 0, 0], [0, 0, 1]),
    ],
)
def test_one_angle_of_roll_pitch_and_yaw_is_clear(words, x, axis):
    """I turns about X, J about Y and K about Z, and what is not given is 0 [Mazak]."""
    program, _ = taken(f"G68.2 P1 X5. {words}\nG53.1\nG0 X1. Y0. Z0.\nM30\n")
    assert np.allclose(program.position[-1], np.add([5.0, 0.0, 0.0], x))
    assert np.allclose(program.tool_axis[-1], axis)


CONTOUR = "G1 X{0} Y{1}\nG2 X{2} Y{1} I{3} J{4}\nG3 X{0} Y{5} R{6}\nG91 G1 X{7}\nG90\n"
NUMBERS = ("xa", "y0"), (15.0, 8.0, 20.0, 2.5, 0.0, 3.0, 30.0, 1.5)


def contour(scale=1.0, x=0.0, y=0.0):
    """The contour with places scaled about x, y and lengths scaled."""
    a, b, c, i, j, d, r, step = NUMBERS[1]
    place_x, place_y = (lambda value: x + scale * (value - x)), (lambda value: y + scale * (value - y))
    values = (place_x(a), place_y(b), place_x(c), scale * i, scale * j, place_y(d), scale * r, scale * step)
    return CONTOUR.format(*(f"{value:.9f}" for value in values))


@pytest.mark.parametrize(("factor", "x", "y"), [(2.0, 10.0, -4.0), (0.5, 0.0, 0.0), (1.25, 3.0, 7.0)])
@pytest.mark.parametrize("by", ["P{0}", "I{0} J{0} K1."])
def test_scaling_is_the_program_with_scaled_numbers(factor, x, y, by):
    word = by.format(factor)
    one, _ = taken(f"G51 X{x} Y{y} Z0. {word}\n{contour()}G50\n{contour()}M30\n")
    other, _ = taken(f"{contour(factor, x, y)}{contour()}M30\n")
    assert np.allclose(one.position, other.position, atol=1e-6)
    assert np.allclose(one.arc_centre, other.arc_centre, atol=1e-6, equal_nan=True)


def test_factors_below_zero_mirror_and_arcs_and_sides_turn_round():
    text = "G51 X10. Y0. Z0. I-2. J2. K1.\nG1 X10. Y0.\nG2 X12. Y2. I2. J0.\nG50\nG1 X0. Y0.\nM30\n"
    program, _ = taken(text)
    assert program.position[1:].tolist() == [[10.0, 0.0, 100.0], [6.0, 4.0, 100.0], [0.0, 0.0, 100.0]]
    assert program.arc_centre[2].tolist() == [6.0, 0.0, 100.0]
    assert program.arc_axis[2].tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G51 X0. Y0. Z0. P2000\nX1.\nG50\nM30\n", [("G434", 1)]),
        ("G51 X0. Y0. P2.\nX1.\nG50\nM30\n", [("G405", 1)]),
        ("G51 X0. Y0. Z0.\nX1.\nG50\nM30\n", [("G405", 1)]),
        ("G51 X0. Y0. I2. J3.\nX1.\nG2 X2. Y0. I.5 J0.\nG50\nM30\n", [("G435", 3)]),
        ("G51 X0. Y0. Z0. P2. I1.\nX1.\nG50\nM30\n", [("G404", 1)]),
        ("G51 X0. Y0. Z0. P2.\nG55\nX1.\nG50\nM30\n", [("G435", 2)]),
        ("G51 X0. Y0. Z0. P2.\nG68 X0. Y0. R20.\nX1.\nG50\nM30\n", [("G435", 2)] * 2),
        ("G51 X0. Y0. Z0. P2.\nG81 X1. Z-1. R2.\nG50\nM30\n", [("G435", 2)]),
    ],
)
def test_what_controls_scale_differently_is_refused(text, expected):
    assert codes(text) == expected


def test_g50_alone_changes_nothing():
    assert taken("G50\nX1.\nM30\n")[0].position[-1].tolist() == [1.0, 0.0, 100.0]


@pytest.mark.parametrize("block", ["G51 X0 Y0 Z0 P2.", "G68.2 X0 Y0 Z0 I0 J0 K0", "G53.1"])
def test_linuxcnc_has_none_of_them(block):
    assert {code for code, _ in codes(f"{block}\nX1.\nM2\n", flavour="rs274")} <= {"G401", "G402"}


UPRIGHT = [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    "text, place",
    [
        ("G18 G68 X0 Z0 R30.\nG1 X10. Z0.\nG69\n", (8.660254, 0, -5)),
        ("G19 G68 Y0 Z0 R90.\nG1 Y10. Z0.\nG69\n", (0, 0, 10)),
        ("G51.1 Z0\nG1 X10. Z-5.\nG50.1\n", (10, 0, 5)),
        ("G51 X0. Y0. Z0. I1. J1. K-1.\nG1 X10. Z-5.\nG50\n", (10, 0, 5)),
    ],
)
@pytest.mark.parametrize("axis_words", ["none", "AC", "vector"])
def test_rotations_and_mirror_images_turn_coordinates_and_not_the_tool(text, place, axis_words):
    program, _ = taken(text, axis_words=axis_words)
    np.testing.assert_allclose(program.position[-1], place, rtol=0, atol=1e-6)
    assert program.tool_axis.tolist() == [UPRIGHT] * len(program)


def test_a_tool_that_is_tilted_stays_so_in_a_rotation_and_words_for_rotary_axes_are_refused_there():
    tilted = "G43.4\nG1 X1. Y0. Z50. A30. C10.\n"
    program, _ = taken(f"{tilted}G68 X0 Y0 R90.\nX5. Y0.\nG69\nX0. Y9.\n", axis_words="AC")
    np.testing.assert_allclose(program.position[-2:], [[0, 5, 50], [0, 9, 50]], rtol=0, atol=1e-9)
    assert (program.tool_axis[-3:] == program.tool_axis[-1]).all() and program.tool_axis[-1, 2] < 0.9
    for turn in ("G68 X0 Y0 R90.", "G51.1 X0"):
        assert codes(f"G43.4\n{turn}\nG1 X1. Y0. A30.\n", axis_words="AC")[-1] == ("G414", 3)
        assert codes(f"G43.4\n{turn}\nG1 X1. Y0. A0. C0.\n", axis_words="AC") == []


def test_a_vector_is_one_of_the_frame_in_which_it_is_written():
    text = "G43.5\nG68 X0 Y0 R90.\nG1 X1. Y0. Z50. I3. J0. K4.\nX2. Y1.\nG69\nX0. Y9.\nI3. J0. K4.\n"
    axes = taken(text, axis_words="vector")[0].tool_axis
    np.testing.assert_allclose(axes[-4:], [[0, 0.6, 0.8]] * 3 + [[0.6, 0, 0.8]], rtol=0, atol=1e-12)


def test_the_angle_of_g10_does_not_turn_the_tool_and_that_of_an_option_does():
    text = "G10 L2 P1 X0 Y0 Z0 R90\nG1 X5 Y0 Z50 B30\n"  # rs274 prints B30 for the move to (0, 5)
    program, _ = taken(text, flavour="rs274", axis_words="RPY")
    np.testing.assert_allclose(program.position[-1], [0, 5, 50], rtol=0, atol=1e-9)
    np.testing.assert_allclose(program.tool_axis[-1], [0.5, 0, np.sqrt(0.75)], rtol=0, atol=1e-12)
    placed = {"G54": (0.0, 0.0, 0.0, 90.0)}
    program, _ = taken("G1 X5 Y0 Z50 B30\n", flavour="rs274", axis_words="RPY", work_offsets=placed)
    np.testing.assert_allclose(program.tool_axis[-1], [0, 0.5, np.sqrt(0.75)], rtol=0, atol=1e-12)


def test_a_cycle_in_a_mirror_image_along_the_tool_is_refused():
    hole = "G99 G81 X1. Y1. Z-5. R2.\nG80\n"
    assert codes(f"G51.1 Z0\n{hole}") == [("G429", 2)]
    assert codes(f"G51.1 X0\n{hole}") == []
