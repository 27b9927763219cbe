# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs joined: rows, events and optional columns in their order."""

import dataclasses

import numpy as np
import pytest
from programs import program

from pkm_post.model import Event, EventKind
from pkm_post.model.program import MOTION_COLUMNS, OPTIONAL_COLUMNS
from pkm_post.toolpath.symmetry.transform import joined, mirror, transform


def test_rows_and_events_follow_each_other():
    events = (Event(0, EventKind.SPINDLE, 5000), Event(3, EventKind.SPINDLE, 0))
    first = program([[0, 0, 30], [1, 2, 0], [3, 4, 0]], events=events)
    second, _ = transform(dataclasses.replace(first, side_offset=[0, 2, 2]), mirror((0, 0, 0), (1, 0, 0)))
    both = joined([first, second])
    assert both.position[:, 0].tolist() == [0, 1, 3, 0, -1, -3]
    assert both.side_offset.tolist() == [0, 0, 0, 0, -2, -2]
    assert [(event.row, event.value) for event in both.events] == [(0, 5000), (3, 0), (3, 5000), (6, 0)]
    assert np.array_equal(both.line, [1, 2, 3, 1, 2, 3])


def test_one_program_stays_as_it_is():
    made = program([[0, 0, 30], [1, 2, 0]])
    assert np.array_equal(joined([made]).position, made.position)
    assert joined([made]).events == made.events


def test_programs_of_other_operations_are_a_fault_of_the_caller():
    made = program([[0, 0, 30]])
    for programs in ([], [made, dataclasses.replace(made, operations=("Other",))]):
        with pytest.raises(ValueError, match="same operations"):
            joined(programs)


def test_every_column_of_each_program_is_there():
    rows = np.arange(3)
    first = program([[0, 0, 30], [1, 2, 0], [3, 4, 0]])
    told = {"exact_stop": rows == 1, "exact_path": rows == 2, "tip_tolerance": 0.01 * rows, "side_offset": 1.0 * rows}
    told |= {"plane": [0, 1, 2], "normal": np.eye(3), "spin": 0.1 * rows, "smaller_tool": rows == 0}
    assert set(told) == set(OPTIONAL_COLUMNS)
    second = dataclasses.replace(first, **told)
    both = joined([first, second, first])
    for name in (*MOTION_COLUMNS, *OPTIONAL_COLUMNS, "position", "tool_axis"):
        for begin, made in enumerate([first, second, first]):
            np.testing.assert_array_equal(getattr(both, name)[3 * begin : 3 * begin + 3], getattr(made, name), name)
