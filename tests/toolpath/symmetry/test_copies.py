# SPDX-License-Identifier: LGPL-2.1-or-later
"""Copies of a program: laws of mirrors and rotations, and what becomes of events."""

import dataclasses

import numpy as np
import pytest
from programs import program

from pkm_post.model import Event, EventKind, Kind
from pkm_post.toolpath import Copies, mirror, rotation, with_copies

QUADRANTS = Copies(("xz", "yz", np.pi))
"""The three copies of the paper's part [paper eq. 12, 13]."""
EVENTS = (
    Event(0, EventKind.TOOL_CHANGE, 1), Event(0, EventKind.SPINDLE, 9000.0), Event(5, EventKind.SPINDLE, 0.0),
)  # fmt: skip


def passes(lean=(0.0, 0.0, 1.0)):
    """Three passes in the first quadrant, each with a plunge and a lift, reached and left by rapid moves."""
    rows = []
    for y in (5.0, 8.0, 11.0):
        rows += [
            (Kind.RAPID, [5, y, 50]), (Kind.LINE, [5, y, 20]), (Kind.LINE, [15, y, 20]), (Kind.LINE, [25, y + 1, 20]),
            (Kind.RAPID, [25, y + 1, 50]),
        ]  # fmt: skip
    kind, position = zip(*rows, strict=True)
    axis = np.tile(np.array(lean) / np.linalg.norm(lean), (len(rows), 1))
    return program(position, axis, kind=np.array(kind), events=EVENTS)


def copied(made, copies):
    result, faults = with_copies(made, copies)
    assert not faults
    return result


def test_no_copies_change_nothing():
    made = passes()
    assert copied(made, Copies()) is made


def test_quadrants_are_the_original_and_its_images_in_the_order_they_were_asked_for():
    made = passes(lean=(0.1, 0.2, 1.0))
    result, size = copied(made, QUADRANTS), len(made)
    signs = [[1, 1, 1], [1, -1, 1], [-1, 1, 1], [-1, -1, 1]]
    for number, sign in enumerate(signs):
        rows = slice(number * size, (number + 1) * size)
        np.testing.assert_allclose(result.position[rows], made.position * sign, atol=1e-12)
        np.testing.assert_allclose(result.tool_axis[rows], made.tool_axis * sign, atol=1e-12)
        np.testing.assert_array_equal(result.kind[rows], made.kind)


@pytest.mark.parametrize("keep_climb", [False, True])
def test_the_copy_of_a_copy_is_the_original(keep_climb):
    made = passes()
    once = copied(made, Copies(("xz",), keep_climb))
    image = rows_of(once, slice(len(made), None))
    twice = copied(image, Copies(("xz",), keep_climb))
    again = rows_of(twice, slice(len(image), None))
    np.testing.assert_allclose(again.position, made.position, atol=1e-12)
    np.testing.assert_array_equal(again.kind, made.kind)


def rows_of(made, rows):
    """A part of a program, without events."""
    columns = {
        field.name: getattr(made, field.name)[rows]
        for field in dataclasses.fields(made)
        if isinstance(getattr(made, field.name), np.ndarray)
    }
    return dataclasses.replace(made, events=(), **columns)


def test_climb_is_kept_by_running_each_pass_the_other_way():
    made = passes()
    result = copied(made, Copies(("yz",), keep_climb=True))
    image = rows_of(result, slice(len(made), None))
    cutting = np.flatnonzero(image.position[:, 2] == 20)[:3]
    np.testing.assert_allclose(image.position[cutting, 0], [-25, -15, -5], atol=1e-12)  # made for +5, +15, +25


def test_the_tool_that_is_in_the_spindle_is_not_changed():
    result = copied(passes(), QUADRANTS)
    kinds = [event.kind for event in result.events]
    assert kinds.count(EventKind.TOOL_CHANGE) == 1
    assert kinds.count(EventKind.SPINDLE) == 8  # on and off in each quadrant


def test_tools_that_alternate_are_changed_in_every_copy():
    made = passes()
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(6, EventKind.TOOL_CHANGE, 2))
    two = dataclasses.replace(
        made, events=events, tools={**made.tools, 2: dataclasses.replace(made.tools[1], number=2)}
    )
    changes = [event.value for event in copied(two, Copies((np.pi,))).events]
    assert changes == [1, 2, 1, 2]


def test_a_program_that_begins_with_a_feed_move_is_refused():
    made = program([[5, 5, 20], [9, 5, 20]], kind=np.array([Kind.LINE, Kind.LINE]))
    result, (fault,) = with_copies(made, QUADRANTS)
    assert result is None and fault.code == "K148"


@pytest.mark.parametrize(("name", "normal"), [("xy", [0, 0, 1]), ("xz", [0, 1, 0]), ("yz", [1, 0, 0])])
def test_names_are_planes_through_the_origin(name, normal):
    made = passes()
    image = copied(made, Copies((name,))).position[len(made) :]
    matrix = mirror([0, 0, 0], normal)
    np.testing.assert_allclose(image, made.position @ matrix[:3, :3].T, atol=1e-12)


def test_angles_are_right_handed_about_z():
    made = passes()
    image = copied(made, Copies((np.radians(30),))).position[len(made) :]
    matrix = rotation([0, 0, 0], [0, 0, 1], np.radians(30))
    np.testing.assert_allclose(image, made.position @ matrix[:3, :3].T, atol=1e-12)


@pytest.mark.parametrize("keep_climb", [False, True])
def test_a_copy_begins_with_the_first_tool_where_that_is_loaded_already(keep_climb):
    made = passes()
    events = (Event(5, EventKind.TOOL_CHANGE, 1), Event(10, EventKind.TOOL_CHANGE, 2))
    two = dataclasses.replace(
        made, events=events, tools={**made.tools, 2: dataclasses.replace(made.tools[1], number=2)}
    )
    moves = ("xz", "yz") if keep_climb else ("xz", np.pi)
    changes = [event for event in copied(two, Copies(moves, keep_climb)).events]
    assert [(each.value, each.row % len(made)) for each in changes] == [
        (1, 5),
        (2, 10),
        (1, 0),
        (2, 10),
        (1, 0),
        (2, 10),
    ]
    assert [each.row // len(made) for each in changes] == [0, 0, 1, 1, 2, 2]
