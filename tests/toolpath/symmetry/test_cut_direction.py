# SPDX-License-Identifier: LGPL-2.1-or-later
"""Climb and conventional milling against the velocities of the teeth; what mirrors and reversals do to it."""

import dataclasses

import numpy as np
import pytest
from machines import rotation_about
from programs import program

from pkm_post.geometry.vectors import cross, dot, unit
from pkm_post.model import Event, EventKind, Kind
from pkm_post.toolpath.symmetry.cut_direction import (
    CutDirection,
    CutLengths,
    cut_directions,
    cut_lengths,
    material_side,
    spindle_sense,
)
from pkm_post.toolpath.symmetry.passes import displacements
from pkm_post.toolpath.symmetry.reverse import reversed_passes
from pkm_post.toolpath.symmetry.transform import mirror, transform

FORWARD, BACKWARD = 1, -1


def round_a_pin(count=40, turns=1.0):
    """A leaning tool that goes counterclockwise round a pin, the normals of its wall known."""
    angle = np.linspace(0, 2 * np.pi * turns, count)
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    axis = unit(np.array([0.0, 0, 1]) + 0.2 * out)
    made = program(20 * out + [0, 0, 10], axis)
    return dataclasses.replace(made, normal=unit(out + [0, 0, 0.1]))


def lifted(made):
    """With a plunge before and a rapid lift behind, along the tool axis."""
    ends = made.position[[0, -1]] + 30 * made.tool_axis[[0, -1]]
    position = np.vstack([ends[:1], made.position, ends[1:]])
    axis = np.vstack([made.tool_axis[:1], made.tool_axis, made.tool_axis[-1:]])
    kind = [Kind.RAPID, *([Kind.LINE] * len(made)), Kind.RAPID]
    blank = np.full((1, 3), np.nan)
    return dataclasses.replace(program(position, axis, kind=kind), normal=np.vstack([blank, made.normal, blank]))


@pytest.mark.parametrize("sense", [FORWARD, BACKWARD])
@pytest.mark.parametrize("seed", range(5))
def test_a_cutter_climbs_where_its_teeth_move_against_the_feed(sense, seed):
    made = round_a_pin()
    turn = np.eye(4)
    turn[:3, :3] = rotation_about(seed % 3, 70.0 * seed)
    moved, _ = transform(made, turn)
    # The tooth at the contact goes round with the angular velocity -sense k, at -n from the axis.
    tooth = cross(-sense * moved.tool_axis, -moved.normal)
    along = dot(tooth, displacements(moved))[1:]
    np.testing.assert_array_equal(cut_directions(moved, spindle_before=sense)[1:], -np.sign(along))


def test_counterclockwise_round_the_outside_is_conventional_with_m3():
    # Shop rule: with M3 an outside contour is climb milled clockwise.
    assert cut_lengths(round_a_pin(), spindle_before=FORWARD).direction is CutDirection.CONVENTIONAL
    assert cut_lengths(round_a_pin(turns=-1.0), spindle_before=FORWARD).direction is CutDirection.CLIMB


def test_g41_is_climb_milling_with_m3():
    made = program([[0, 0, 0], [10, 0, 0], [10, 10, 0]])
    left = dataclasses.replace(made, side_offset=np.full(3, 5.0))
    assert cut_directions(left, spindle_before=FORWARD).tolist() == [0, 1, 1]
    assert cut_directions(left, spindle_before=BACKWARD).tolist() == [0, -1, -1]
    right = dataclasses.replace(made, side_offset=np.full(3, -5.0))
    assert cut_directions(right, spindle_before=FORWARD).tolist() == [0, -1, -1]


def test_compensation_and_normals_tell_the_same():
    by_normal = program([[0, 0, 0], [10, 0, 0]])
    by_normal = dataclasses.replace(by_normal, normal=np.array([[0, 1.0, 0]] * 2))  # the material is at -y: right
    by_side = dataclasses.replace(program([[0, 0, 0], [10, 0, 0]]), side_offset=np.full(2, 5.0))
    assert material_side(by_normal).tolist() == material_side(by_side).tolist() == [0, 1]


@pytest.mark.parametrize(
    ("given", "sense", "found"),
    [(0, 1, CutDirection.UNKNOWN), (1, 0, CutDirection.UNKNOWN), (1, 1, CutDirection.CLIMB),
     (-1, 1, CutDirection.CONVENTIONAL), (-1, -1, CutDirection.CLIMB)],
)  # fmt: skip
def test_where_nothing_tells_it_is_unknown(given, sense, found):
    made = program([[0, 0, 0], [10, 0, 0]])
    assert cut_lengths(made, given, sense).direction is found


def test_a_cutter_that_stands_on_the_surface_has_no_side():
    made = dataclasses.replace(program([[0, 0, 0], [10, 0, 0]]), normal=np.array([[0, 0, 1.0]] * 2))
    assert cut_lengths(made, spindle_before=FORWARD) == CutLengths(0.0, 0.0, 10.0)
    assert not material_side(made, given=1).any()


def test_the_spindle_is_as_its_events_say():
    made = program([[0, 0, 0]] * 5, events=[Event(1, EventKind.SPINDLE, 9000), Event(3, EventKind.SPINDLE, -9000)])
    made = dataclasses.replace(made, events=(*made.events, Event(4, EventKind.SPINDLE, 0)))
    assert spindle_sense(made).tolist() == [0, 1, 1, -1, 0]


@pytest.mark.parametrize("normal", [[1, 0, 0], [0, 1, 0], [1, 2, 3]])
def test_a_mirror_makes_conventional_of_climb_and_a_reversal_brings_it_back(normal):
    made = lifted(round_a_pin(turns=-0.25))
    copy, _ = transform(made, mirror([5, 0, 0], normal))
    back, _ = reversed_passes(copy)
    found = [cut_lengths(each, spindle_before=FORWARD) for each in (made, copy, back)]
    assert [each.direction for each in found] == [
        CutDirection.CLIMB,
        CutDirection.CONVENTIONAL,
        CutDirection.CLIMB,
    ]
    np.testing.assert_allclose(found[2].climb, found[0].climb, rtol=1e-12)


def test_to_and_fro_is_both():
    assert CutLengths(50.0, 50.0, 0.0).direction is CutDirection.BOTH
    assert CutLengths(95.0, 5.0, 0.0).direction is CutDirection.CLIMB
    assert CutLengths(50.0, 0.0, 50.0).direction is CutDirection.UNKNOWN
