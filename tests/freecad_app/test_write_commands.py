# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program written as commands and read again is the same to six decimals; arcs no G2 or G3 can say become chords."""

import dataclasses

import numpy as np
import Path
import pytest
from programs import cone, program, square_with_arc

from pkm_post.freecad_app.commands import commands_of, read_commands
from pkm_post.geometry import angle_between, arc_points, arc_sweep, norm
from pkm_post.model import Event, EventKind, Kind
from pkm_post.toolpath.symmetry.transform import mirror, rotation, transform

MICRON = 1e-3
ROUNDING = 1e-6
"""Numbers are read with the six decimals that FreeCAD saves: half of the last, and for differences all of it."""
ORIGIN = (0, 0, 0)
COLUMNS = ("kind", "position", "tool_axis", "feed", "arc_centre", "arc_axis")


def read(commands):
    back, faults = read_commands(commands, "part.FCStd", "Finish")
    assert faults == ()
    return back


def names(commands):
    return [command.Name for command in commands]


@pytest.mark.parametrize("original", [cone(30), square_with_arc()], ids=["cone", "square"])
def test_round_trip(original):
    back = read(commands_of(original))
    for column in COLUMNS:
        np.testing.assert_allclose(getattr(back, column), getattr(original, column), rtol=0, atol=ROUNDING)
    assert back.events == original.events


def test_mirror_in_an_upright_plane_makes_g3_of_g2():
    commands = [Path.Command(line) for line in ("G0 X0 Y0 Z0", "G2 X10 Y0 I5 J0 F1", "G3 X20 Y0 Z3 I5 J0")]
    copy, _ = transform(read(commands), mirror(ORIGIN, (1, 0, 0)))
    assert names(commands_of(copy)) == ["G0", "G3", "G2"]


def test_upright_tool_axes_are_not_written():
    upright, leaning = commands_of(square_with_arc()), commands_of(cone(3))
    assert [sorted(command.Parameters) for command in upright[1:3]] == [["X", "Y", "Z"], ["F", "X", "Y", "Z"]]
    assert sorted(leaning[2].Parameters) == sorted("XYZIJKF")


def test_words_have_all_digits_and_no_minus_before_zero():
    words = commands_of(program([[1 / 3, -0.0, 0], [0, 0, 1e-9]]))[1].Parameters
    assert words["X"] == 1 / 3
    assert str(words["Y"]) == "0.0"


def turned_square():
    turned, _ = transform(square_with_arc(), rotation(ORIGIN, (1, 0, 0), 0.3))
    return turned


def test_arcs_in_other_planes_become_chords_a_micron_off_at_most():
    turned = turned_square()
    back = read(commands_of(turned))
    assert set(back.kind) == {Kind.RAPID, Kind.LINE}
    arc = 3
    start, end = turned.position[arc - 1 : arc], turned.position[arc : arc + 1]
    centre, axis = turned.arc_centre[arc : arc + 1], turned.arc_axis[arc : arc + 1]
    chords = np.flatnonzero(norm(back.position - centre) < 10 + MICRON)
    np.testing.assert_allclose(back.position[chords[[0, -1]]], np.vstack([start, end]), atol=ROUNDING)
    np.testing.assert_allclose(norm(back.position[chords] - centre), 10.0, atol=ROUNDING)
    sagitta = 10 - norm((back.position[chords[1:]] + back.position[chords[:-1]]) / 2 - centre)
    assert 0.9 * MICRON < sagitta.max() <= MICRON
    middle = arc_points(start, centre, axis, arc_sweep(start, end, centre, axis) / 2, np.zeros(1))
    assert norm(back.position[chords] - middle).min() < 0.5


def test_chords_of_a_full_helix_rise_evenly():
    turned = turned_square()
    back = read(commands_of(turned))
    helix = back.position[np.flatnonzero(norm(back.position - turned.position[5]) < ROUNDING)[-1] :]
    rise = np.diff(helix @ turned.arc_axis[6])
    assert len(helix) > 100
    np.testing.assert_allclose(rise, rise.mean(), rtol=0, atol=2 * ROUNDING)
    np.testing.assert_allclose(helix[-1], turned.position[6], rtol=0, atol=ROUNDING)


def test_tool_axis_turns_along_an_arc_by_even_steps():
    leaning = np.tile([0.0, 0.0, 1.0], (3, 1))
    leaning[2] = [0.6, 0.0, 0.8]
    centre, turn = np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    centre[2], turn[2] = [5, 0, 0], [0, 0, 1]
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC]
    original = program([[0, 0, 9], [0, 0, 0], [10, 0, 0]], leaning, kind=kind, centre=centre, turn=turn)
    back = read(commands_of(original))
    assert set(back.kind) == {Kind.RAPID, Kind.LINE}
    steps = angle_between(back.tool_axis[1:-1], back.tool_axis[2:])
    np.testing.assert_allclose(steps, steps.mean(), rtol=0, atol=2 * ROUNDING)
    np.testing.assert_allclose(steps.sum(), np.arccos(0.8), atol=ROUNDING)


def test_events_stay_where_they_were_when_arcs_become_chords():
    events = (
        Event(0, EventKind.TOOL_CHANGE, 4),
        Event(1, EventKind.SPINDLE, -750.0),
        Event(4, EventKind.DWELL, 0.25),
        Event(6, EventKind.COOLANT, 2),
        Event(7, EventKind.SPINDLE, 0),
        Event(7, EventKind.STOP, 1),
    )
    turned = dataclasses.replace(turned_square(), events=events)
    back = read(commands_of(turned))
    assert [(event.kind, event.value) for event in back.events] == [(event.kind, event.value) for event in events]
    for before, after in zip(events, back.events, strict=True):
        if before.row > 0:
            reached = back.position[after.row - 1]
            np.testing.assert_allclose(reached, turned.position[before.row - 1], atol=1e-9)
    assert back.events[-1].row == len(back)


def test_arc_without_a_start_is_the_callers_fault():
    lone = program([[10, 0, 0]], kind=[Kind.ARC], centre=[[5, 0, 0]], turn=[[0, 0, 1]])
    with pytest.raises(ValueError, match="first row"):
        commands_of(lone)
