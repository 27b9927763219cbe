# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is written is read back bit for bit, and nothing is written that could not be."""

import dataclasses

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, square_with_arc
from trajectories import everything, fitted, random_trajectory

from pkm_post.model import Event, EventKind, Kind, Tool
from pkm_post.model.certificate import Tolerances
from pkm_post.toolpath.place import place
from pkm_post.writing.trajectory_file import read, write
from pkm_post.writing.trajectory_file.invariants import VALID_EVENT_VALUE


def read_back(trajectory, path):
    write(trajectory, path)
    result, diagnostics = read(path)
    assert diagnostics == ()
    return result


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_what_is_written_is_read_back(tmp_path, seed):
    count, events = ((1, 0), (2, 1), (20, 6), (1000, 50))[seed % 4]
    trajectory = random_trajectory(seed, count, events)
    assert everything(read_back(trajectory, tmp_path / "part.pkmt")) == everything(trajectory)


def test_a_trajectory_without_segments_is_read_back(tmp_path):
    trajectory = dataclasses.replace(random_trajectory(1, count=0, events=2), operations=(), tools={})
    assert everything(read_back(trajectory, tmp_path / "part.pkmt")) == everything(trajectory)


@pytest.mark.parametrize("program", [cone(), square_with_arc()])
def test_a_placed_program_is_read_back(tmp_path, program):
    trajectory, _ = place(program, example(), ON_PALLET)
    assert everything(read_back(trajectory, tmp_path / "part.pkmt")) == everything(trajectory)


def test_the_same_trajectory_gives_the_same_bytes(tmp_path):
    trajectory = random_trajectory(2)
    other_order = dataclasses.replace(trajectory, tools=dict(reversed(trajectory.tools.items())))
    write(trajectory, tmp_path / "first.pkmt")
    write(other_order, tmp_path / "second.pkmt")
    assert (tmp_path / "first.pkmt").read_bytes() == (tmp_path / "second.pkmt").read_bytes()


def test_reading_and_writing_again_gives_the_same_bytes(tmp_path):
    again = read_back(random_trajectory(3), tmp_path / "first.pkmt")
    write(again, tmp_path / "second.pkmt")
    assert (tmp_path / "first.pkmt").read_bytes() == (tmp_path / "second.pkmt").read_bytes()


def test_an_older_file_is_replaced_and_nothing_else_left(tmp_path):
    path = tmp_path / "new folder" / "part.pkmt"
    write(random_trajectory(4, count=500), path)
    trajectory = random_trajectory(5, count=3)
    assert everything(read_back(trajectory, path)) == everything(trajectory)
    assert list(path.parent.iterdir()) == [path]


def with_row(trajectory, column, row, value):
    changed = getattr(trajectory, column).copy()
    changed[row] = value
    return dataclasses.replace(trajectory, **{column: changed})


BAD_SEGMENTS = [
    ("kind", 3, "kind is unknown"),
    ("tip", np.inf, "tip is not finite"),
    ("tip", -1.1e9, "tip is not finite, or farther"),
    ("axis", [0, 0, 0.999], "axis is not of unit length"),
    ("axis", np.nan, "axis is not of unit length"),
    ("axis", 1e300, "axis is not of unit length"),
    ("spin", np.nan, "spin is not finite"),
    ("feed", np.nan, "feed is not"),
    ("feed", 0, "feed is not"),
    ("feed", np.inf, "feed is not"),
    ("length", -1, "length is not"),
    ("length", np.inf, "length is not"),
    ("angle", 3.2, "angle is not"),
    ("tool", 4, "tool is not in the table"),
    ("operation", 3, "operation is not in the table"),
    ("operation", -1, "operation is not in the table"),
    ("line", -1, "line is negative"),
]


@pytest.mark.parametrize(("column", "value", "found"), BAD_SEGMENTS)
def test_a_trajectory_that_violates_an_invariant_is_not_written(tmp_path, column, value, found):
    with pytest.raises(ValueError, match=f"segment 7: the {found}"):
        write(with_row(random_trajectory(6), column, 7, value), tmp_path / "part.pkmt")
    assert list(tmp_path.iterdir()) == []


BAD_ARCS = [
    (True, "sweep", 0, "sweep is not above 0"),
    (True, "sweep", 6.3, "sweep is not above 0"),
    (True, "arc_centre", np.nan, "arc centre is not finite"),
    (True, "arc_axis", [0, 1, 1], "arc axis is not of unit length"),
    (False, "sweep", 1, "sweep is not 0"),
    (False, "arc_centre", 1, "arc centre is not NaN"),
    (False, "arc_axis", [0, 0, 1], "arc axis is not NaN"),
]


@pytest.mark.parametrize(("on_arc", "column", "value", "found"), BAD_ARCS)
def test_arc_columns_belong_to_arcs(tmp_path, on_arc, column, value, found):
    trajectory = random_trajectory(7)
    row = int(np.flatnonzero((trajectory.kind == 2) == on_arc)[0])
    with pytest.raises(ValueError, match=f"segment {row}: the {found}"):
        write(with_row(trajectory, column, row, value), tmp_path / "part.pkmt")


BAD_REST = {
    "the start tip is not finite": {"start_tip": [0, np.nan, 0]},
    "the start axis is not of unit length": {"start_axis": [0, 0, -1.1]},
    "the start spin is not finite": {"start_spin": np.inf},
    "the work offset is not a rotation": {"machine_from_work": 2 * np.eye(4)},
    "the work offset is not a rotation and": {"machine_from_work": np.diag([1, 1, -1, 1])},
    "the work offset is not a rotation and a": {"machine_from_work": np.diag([1, 1, 1, 2])},
    "the fingerprint 'ABC' is not": {"machine_fingerprint": "ABC"},
    "instruction 1: the row 21 is not between": {
        "events": (Event(20, EventKind.STOP, 0.0), Event(21, EventKind.STOP, 0.0))
    },
    "instruction 0: the row -1 is not between": {"events": (Event(-1, EventKind.STOP, 0.0),)},
    "the row 3 is before": {"events": (Event(4, EventKind.STOP, 0.0), Event(3, EventKind.STOP, 0.0))},
    "DWELL cannot have the value -1.0": {"events": (Event(0, EventKind.DWELL, -1.0),)},
    "the length of tool 1 is nan mm": {"tools": {1: Tool(1, "mill", 6.0, 0.0, np.nan)}},
    "the number of tool 1 is 2, and 1 more": {
        "tools": {1: Tool(2, "mill", 6.0, 0.0, 100.0), -3: Tool(-3, "mill", 6.0, 0.0, 100.0)}
    },
    "the fingerprint 'abc' of the source is not": {"source_fingerprint": "abc"},
    "of the source is not 64 digits of 0-9 and a-f, or all are 0": {"source_fingerprint": "0" * 64},
    "the tolerances 0.0 mm and 0.1 rad are not both": {"tolerances": Tolerances(0.0, 0.1)},
    "the tolerances 0.1 mm and nan rad are not both": {"tolerances": Tolerances(0.1, np.nan)},
    "the bottom angle of tool 1 is nan rad": {"tools": {1: Tool(1, "mill", 6.0, 0.0, 9.0, np.nan)}},
    "surrogates not allowed": {"source": "part\udcff.FCStd"},
}


@pytest.mark.parametrize(("found", "change"), BAD_REST.items(), ids=BAD_REST)
def test_a_file_that_could_not_be_read_is_not_written(tmp_path, found, change):
    with pytest.raises(ValueError, match=found):
        write(dataclasses.replace(random_trajectory(8), **change), tmp_path / "part.pkmt")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("moving", ["length", "angle", "spin", None])
def test_a_segment_moves_tip_axis_or_spin(tmp_path, moving):
    trajectory = random_trajectory(9)
    row = int(np.flatnonzero(trajectory.kind[1:] != Kind.ARC)[0]) + 1
    for name, column, value in (
        ("angle", "axis", trajectory.axis[row - 1]),
        ("spin", "spin", trajectory.spin[row - 1]),
        ("length", "tip", trajectory.tip_before()[row]),
    ):
        if name != moving:
            trajectory = fitted(with_row(trajectory, column, row, value))
    if moving:
        assert everything(read_back(trajectory, tmp_path / "part.pkmt")) == everything(trajectory)
    else:
        with pytest.raises(ValueError, match=f"segment {row}: the tip, the axis and the spin all stand"):
            write(trajectory, tmp_path / "part.pkmt")


@pytest.mark.parametrize(
    ("column", "on_arc", "what"), [("sweep", True, "tip"), ("angle", False, "axis"), ("length", False, "length")]
)
def test_a_segment_ends_where_it_says(tmp_path, column, on_arc, what):
    trajectory = random_trajectory(10)
    row = int(np.flatnonzero((trajectory.kind == 2) == on_arc)[-1])
    wrong = with_row(trajectory, column, row, getattr(trajectory, column)[row] / 2)
    with pytest.raises(ValueError, match=f"segment {row}: the {what} does not follow from the rest"):
        write(wrong, tmp_path / "part.pkmt")
    assert list(tmp_path.iterdir()) == []


def test_every_kind_of_event_has_its_values():
    assert set(VALID_EVENT_VALUE) == set(EventKind)
