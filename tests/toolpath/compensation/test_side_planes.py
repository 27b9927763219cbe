# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planes of compensation: the three named ones, those normal to a leaning tool, and where there is none."""

from dataclasses import replace

import numpy as np
import pytest
from contour_programs import contour, in_plane, random_contour
from programs import program

from pkm_post.model import Kind, Tool
from pkm_post.reading import gcode, siemens
from pkm_post.reading.gcode import ReadOptions
from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3
ROUNDING = 1e-9


def codes(faults):
    return [(fault.code, fault.place.line) for fault in faults]


def turned(given, rotation):
    """The program turned about the origin, its offsets and planes as they were."""
    return replace(
        given,
        position=given.position @ rotation.T,
        tool_axis=given.tool_axis @ rotation.T,
        arc_centre=given.arc_centre @ rotation.T,
        arc_axis=given.arc_axis @ rotation.T,
    )


def lean(about, angle_deg):
    """A rotation about a coordinate axis."""
    cosine, sine = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    first, second = [(1, 2), (2, 0), (0, 1)][about]
    rotation = np.eye(3)
    rotation[[first, second], [first, second]] = cosine
    rotation[first, second], rotation[second, first] = -sine, sine
    return rotation


@pytest.mark.slow
@pytest.mark.parametrize("corners", ["chord", "arc"])
@pytest.mark.parametrize("plane", [1, 0], ids=["ZX", "YZ"])
def test_all_planes_do_the_same(plane, corners):
    compared = 0
    for seed in range(30):
        flat = random_contour(np.random.default_rng(seed), 3.0, 2)
        other = random_contour(np.random.default_rng(seed), 3.0, plane)
        moved, _ = offset_contours(flat, OffsetOptions(corners))
        moved_other, _ = offset_contours(other, OffsetOptions(corners))
        assert (moved is None) == (moved_other is None)
        if moved is None:
            continue
        np.testing.assert_allclose(in_plane(moved_other.position, plane), moved.position[:, :2], atol=ROUNDING)
        np.testing.assert_allclose(moved_other.position[:, plane], moved.position[:, 2], atol=ROUNDING)
        np.testing.assert_allclose(moved_other.arc_axis[:, plane], moved.arc_axis[:, 2], atol=ROUNDING)
        compared += 1
    assert compared > 15


def test_a_tool_that_lies_in_the_plane_is_offset_in_the_plane():
    """A ball in G18 on an upright spindle, as controls have it."""
    for seed in range(10):
        given = random_contour(np.random.default_rng(seed), 3.0, 1)
        upright = replace(given, tool_axis=np.tile([0.0, 0.0, 1.0], (len(given), 1)))
        moved, _ = offset_contours(given)
        of_upright, _ = offset_contours(upright)
        assert (moved is None) == (of_upright is None)
        if moved is not None:
            np.testing.assert_array_equal(moved.position, of_upright.position)


@pytest.mark.slow
@pytest.mark.parametrize("corners", ["chord", "arc"])
@pytest.mark.parametrize(("about", "angle"), [(0, 20.0), (1, -35.0), (0, 55.0), (1, 180.0)])
def test_side_milling_with_a_leaning_tool_is_the_same_in_the_plane_normal_to_it(about, angle, corners):
    """A contour turned with its tool is offset as the upright one, then turned.

    A tool that comes from below keeps left and right of the named plane, so there the side changes.
    """
    rotation = lean(about, angle)
    compared = 0
    for seed in range(30):
        given = random_contour(np.random.default_rng(seed), 3.0)
        sense = 1.0 if abs(angle) < 90 else -1.0
        leaning = replace(turned(given, rotation), side_offset=sense * given.side_offset)
        moved, _ = offset_contours(given, OffsetOptions(corners))
        of_leaning, _ = offset_contours(leaning, OffsetOptions(corners))
        assert (moved is None) == (of_leaning is None)
        if moved is None:
            continue
        np.testing.assert_allclose(of_leaning.position, moved.position @ rotation.T, atol=ROUNDING)
        np.testing.assert_allclose(of_leaning.arc_axis, moved.arc_axis @ rotation.T, atol=ROUNDING)
        compared += 1
    assert compared > 15


def test_a_tool_that_turns_along_a_cone_keeps_its_radius_from_the_foot():
    """Side milling of a cone: at each corner the axis is its radius away from the point, at right angles to it."""
    angle = np.linspace(0, 2 * np.pi, 721)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    foot = 40.0 * circle
    axis = np.cos(np.radians(15)) * np.array([0, 0, 1.0]) - np.sin(np.radians(15)) * circle
    points = np.vstack([2 * foot[:1] + [0, 30.0, 0], foot, 2 * foot[-1:] - [0, 30.0, 0]])
    axes = np.vstack([axis[:1], axis, axis[-1:]])
    given = program(points, axes)
    side = np.full(len(given), -6.0)
    side[[0, -1]] = 0.0
    moved, faults = offset_contours(replace(given, side_offset=side), OffsetOptions(tolerance=0.01))
    assert faults == ()
    away = moved.position[1:-1] - foot
    np.testing.assert_allclose(np.sum(away * axis, axis=1), 0.0, atol=ROUNDING)
    # At a corner of two chords the tool is R / cos(turn / 2) away: half a degree is 0.06 um more.
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 6.0, atol=MICRON)
    assert np.all(np.sum(away * circle, axis=1) > 0)


def test_a_tool_that_leans_too_far_says_no_plane():
    given = contour((0.0, 40.0), [(0.0, 0.0), (40.0, 0.0), (80.0, 0.0)], 5.0, axis=lean(0, 70.0)[:, 2])
    moved, faults = offset_contours(given)
    assert moved is None
    assert {fault.code for fault in faults} == {"N206"}
    assert {fault.place.line for fault in faults} == {2, 3, 4}


def test_the_axis_may_not_turn_between_two_blocks():
    given = contour((0.0, 40.0), [(0.0, 0.0), (40.0, 0.0), (40.0, 0.0), (40.0, -40.0), (80.0, -40.0)], 5.0)
    axis = np.tile([0.0, 0.0, 1.0], (len(given), 1))
    axis[3:] = lean(0, 5.0)[:, 2]
    moved, faults = offset_contours(replace(given, tool_axis=axis))
    assert moved is None
    assert codes(faults) == [("N206", 5)]
    assert "turns" in faults[0].found


def test_the_plane_may_not_change():
    given = contour((0.0, 40.0), [(0.0, 0.0), (40.0, 0.0), (80.0, -40.0), (90.0, -40.0)], 5.0)
    plane = np.where(np.arange(len(given)) >= 3, 1, 2)
    moved, faults = offset_contours(replace(given, plane=plane))
    assert moved is None
    assert ("N206", 4) in codes(faults)
    assert "another plane is chosen" in {fault.found for fault in faults}


def test_arcs_lie_in_the_plane():
    given = contour((0.0, 40.0), [(0.0, 0.0), (40.0, 0.0), (80.0, 0.0), (120.0, 0.0)], 5.0)
    kind, centre, axis = given.kind.copy(), given.arc_centre.copy(), given.arc_axis.copy()
    kind[3], centre[3], axis[3] = Kind.ARC, [60, 0, 0], [0, 1, 0]
    moved, faults = offset_contours(replace(given, kind=kind, arc_centre=centre, arc_axis=axis))
    assert moved is None
    assert codes(faults) == [("N206", 4)]
    assert faults[0].found == "an arc outside the plane"


CONTOUR = (
    "G0 X0. Y-10. Z30.\nG1 Z-3. F100.\n{side} D1 X8. Y0.\nX20.\nG3 X30. Y10. {r}10.\nG1 Y20. Z-4.\nG2 X24. Y26. {r}6.\n"
    "G1 X0.\nG40 X0. Y40.\nG0 Z30.\n"
)


def compensated(reader, text):
    given, faults = reader(text, "part", ReadOptions(default_tool=Tool(1, "", 4.0, 0.0, 50.0)))
    assert given is not None, faults
    moved, faults = offset_contours(given, OffsetOptions())
    assert moved is not None, faults
    return moved


@pytest.mark.parametrize("side", ["G41", "G42"])
@pytest.mark.parametrize("angles", [(0, -30, 0), (30, 70, 0), (-120, 150, 200), (10, 90, 45), (45, 54.7356, 0)])
def test_a_contour_in_a_tilted_plane_is_the_flat_one_turned(side, angles):
    """[Fanuc] G68.2 turns by I about Z, J about the new X and K about the new Z."""
    contour = CONTOUR.format(side=side, r="R")
    head = "O1\nG21 G90 G94 G17\nT1 M6\nG0 X0. Y0. Z100.\n"
    flat = compensated(gcode.read, f"{head}{contour}M30\n")
    i, j, k = angles
    plane = f"G68.2 X1. Y2. Z3. I{i}. J{j} K{k}.\nG53.1\n"
    tilted = compensated(gcode.read, f"{head}{plane}{contour}M30\n")
    turn = lean(2, i) @ lean(0, j) @ lean(2, k)
    expected = flat.position[1:] @ turn.T + np.array([1.0, 2.0, 3.0])
    np.testing.assert_allclose(tilted.position[1:], expected, atol=1e-6)


@pytest.mark.parametrize("side", ["G41", "G42"])
@pytest.mark.parametrize("angle", [-40, 80, 135])
def test_in_siemens_language_too_where_the_tool_is_normal_to_the_frame(side, angle):
    contour = CONTOUR.format(side=side, r="CR=")
    head = "G90 G17 G71 G94 G54\nT1 D1\nM6\nG0 X0 Y0 Z100\n"
    flat = compensated(siemens.read, f"{head}{contour}M30\n")
    tilted = compensated(siemens.read, f"{head}ROT X{angle}\nTRAORI\nG0 X0 Y0 Z100 A3=0 B3=0 C3=1\n{contour}M30\n")
    expected = flat.position[1:] @ lean(0, angle).T
    np.testing.assert_allclose(tilted.position[-len(expected) :], expected, atol=1e-6)


def test_a_turned_plane_that_is_not_normal_to_the_tool_is_refused():
    text = "G90 G17 G71 G94 G54\nT1 D1\nM6\nG0 X0 Y0 Z100\nROT X30\nG1 F100\nG41 X8 Y0\nX20\nG40 X30\nM30\n"
    given, faults = siemens.read(text, "part", ReadOptions(default_tool=Tool(1, "", 4.0, 0.0, 50.0)))
    assert (given, {fault.code for fault in faults}) == (None, {"G419"})
