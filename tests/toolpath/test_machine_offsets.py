# SPDX-License-Identifier: LGPL-2.1-or-later
"""Offsets that were changed at the machine: the trajectory is the one that another posting with them has."""

from dataclasses import replace

import numpy as np
import pytest
from machines import example, with_tool_change
from programs import BALL, ON_PALLET, TOOLS, random_changes, square_with_arc

from pkm_post.model import TRAJECTORY_COLUMNS, Event, EventKind
from pkm_post.toolpath import MachineOffsets, place, with_machine_offsets

MACHINES = {"in place": example(), "at a pose": with_tool_change(example())}


def posted(made, machine, shift=(0, 0, 0), lengths=None):
    offset = np.array(ON_PALLET)
    offset[:3, 3] += shift
    tools = {
        number: replace(tool, length=(lengths or {}).get(number, tool.length)) for number, tool in made.tools.items()
    }
    trajectory, faults = place(replace(made, tools=tools), machine, offset)
    assert trajectory is not None, faults
    return trajectory


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_the_trajectory_is_that_of_another_posting(seed, machine):
    rng = np.random.default_rng(seed)
    made = random_changes(rng)
    shift = tuple(rng.uniform(-3, 3, 3).tolist())
    lengths = {number: tool.length + rng.uniform(-5, 5) for number, tool in TOOLS.items() if rng.random() < 0.7}
    used = {tool.number for tool in posted(made, machine).tools.values()}
    offsets = MachineOffsets(shift, {number: length for number, length in lengths.items() if number in used})
    found, faults = with_machine_offsets(posted(made, machine), machine, offsets)
    assert not faults
    wanted = posted(made, machine, shift, lengths)
    for name in set(TRAJECTORY_COLUMNS) - {"smooth"}:
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), atol=1e-9, err_msg=name)
    assert not (found.smooth & ~wanted.smooth).any()
    np.testing.assert_allclose(found.tip_before(), wanted.tip_before(), atol=1e-9)
    np.testing.assert_allclose(found.machine_from_work, wanted.machine_from_work)
    assert found.tools == wanted.tools and found.events == wanted.events


def test_arcs_move_with_the_part():
    machine = MACHINES["in place"]
    found, faults = with_machine_offsets(posted(square_with_arc(), machine), machine, MachineOffsets((1.0, -2.0, 3.0)))
    wanted = posted(square_with_arc(), machine, (1.0, -2.0, 3.0))
    assert not faults
    np.testing.assert_allclose(found.arc_centre, wanted.arc_centre)
    np.testing.assert_allclose(found.length, wanted.length)


def test_what_does_not_fit_is_refused():
    machine, made = MACHINES["in place"], square_with_arc()
    trajectory = posted(made, machine)
    assert with_machine_offsets(trajectory, machine, MachineOffsets()) == (trajectory, ())
    found, faults = with_machine_offsets(trajectory, machine, MachineOffsets(lengths={7: 80.0, 9: 90.0}))
    assert found is None and [(each.code, each.found) for each in faults] == [("C209", "tool 7, 9")]
    arc = int(np.flatnonzero(trajectory.kind == 2)[0])
    other = replace(BALL, number=2)
    events = (*trajectory.events, Event(arc, EventKind.TOOL_CHANGE, 2))
    tools = np.where(np.arange(len(trajectory)) < arc, trajectory.tool, 2)
    changed = replace(trajectory, tools=trajectory.tools | {2: other}, events=events, tool=tools)
    found, faults = with_machine_offsets(changed, machine, MachineOffsets(lengths={2: 121.5}))
    assert found is None and [each.code for each in faults] == ["C209"] and "1.500 mm" in str(faults[0])
