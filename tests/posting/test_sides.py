# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sides of a part that is turned over are posted one by one, each as if a file had it alone."""

from dataclasses import replace

import numpy as np
import pytest

from pkm_post.model import Event, EventKind, Refused
from pkm_post.options import Options, options_from, parse_text
from pkm_post.posting import post_file
from pkm_post.reading import AS_WRITTEN
from pkm_post.reading.part_program import read_content
from pkm_post.toolpath.sides import side_starts, with_side

HEAD = "UNITS/MM\nLOADTL/1,LENGTH,60\nSPINDL/3000,RPM,CLW\nCOOLNT/ON\nFEDRAT/MMPM,600\n"
TAIL = "SPINDL/OFF\nCOOLNT/OFF\nEND\nFINI\n"
UPPER = "RAPID\nGOTO/0,0,30,0,0,1\nGOTO/10,0,20,0,0,1\nGOTO/20,5,20,0,0.6,0.8\nRAPID\nGOTO/20,5,30,0,0,1\n"
LOWER = "RAPID\nGOTO/0,-9,-30,0,0,-1\nGOTO/10,-9,-20,0,0,-1\nGOTO/20,-4,-21,0,0.6,-0.8\nRAPID\nGOTO/20,-9,-30,0,0,-1\n"
LOWER_BY_HAND = "RAPID\nGOTO/0,9,30,0,0,1\nGOTO/10,9,20,0,0,1\nGOTO/20,4,21,0,-0.6,0.8\nRAPID\nGOTO/20,9,30,0,0,1\n"
"""The lower side, turned by half a turn about X by hand: signs of Y and Z changed."""
BOTH = f"{HEAD}{UPPER}{LOWER}{TAIL}"

UPRIGHT = np.eye(4)
UPRIGHT[2, 3] = 250.0
TURNED_OVER = UPRIGHT @ np.diag([1.0, -1.0, -1.0, 1.0])


def posted(folder, text, offset=UPRIGHT, side=None):
    """The result of posting a file with this text."""
    folder.mkdir(exist_ok=True)
    (folder / "part.cls").write_text(text, encoding="ascii")
    options = Options(work_offset=offset, side=side)
    return post_file(folder / "part.cls", "example_6tps", folder / "out", options)


def statements(result):
    """The statements of a program, without what its heading says of files and lines of its operations' comments."""
    lines = result.program.read_text(encoding="ascii").splitlines()
    return [line for line in lines if line and not line.startswith(";")]


def test_a_part_that_is_turned_over_is_refused_and_the_cure_names_the_option(tmp_path):
    with pytest.raises(Refused, match="K106") as refused:
        posted(tmp_path, BOTH)
    assert "--side N" in str(refused.value)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("side", "offset", "alone", "alone_offset"),
    [(1, UPRIGHT, UPPER, UPRIGHT), (2, TURNED_OVER, LOWER, TURNED_OVER), (2, TURNED_OVER, LOWER_BY_HAND, UPRIGHT)],
)
def test_a_side_is_what_a_file_of_it_alone_is(tmp_path, side, offset, alone, alone_offset):
    found = posted(tmp_path / "both", BOTH, offset, side)
    expected = posted(tmp_path / "alone", f"{HEAD}{alone}{TAIL}", alone_offset)
    assert statements(found) == statements(expected)
    assert len(statements(found)) > 20
    assert f"side {side} of 2, as chosen" in found.report["program"]["reading"]


def test_spindle_and_coolant_are_on_in_both_sides_and_off_behind_each():
    """They are switched once in the file, before the first side and behind the last."""
    program, faults = read_content(BOTH.encode(), "part.cls", AS_WRITTEN)
    assert not faults and program is not None
    (begin, turned), sides = side_starts(program), [with_side(program, number)[0] for number in (1, 2)]
    assert (begin, [len(side) for side in sides]) == (0, [turned, len(program) - turned])
    for side in sides:
        switched = {kind: [(each.row, each.value) for each in side.events if each.kind is kind] for kind in EventKind}
        assert switched[EventKind.TOOL_CHANGE] == [(0, 1)]
        assert switched[EventKind.SPINDLE] == [(0, 3000), (len(side), 0)]
        assert switched[EventKind.COOLANT] == [(0, 1), (len(side), 0)]
    np.testing.assert_array_equal(np.vstack([side.position for side in sides]), program.position)


def test_flood_and_mist_that_are_both_on_are_so_on_both_sides():
    """As on LinuxCNC [M7, M8, M9], where one does not end the other."""
    program, faults = read_content(BOTH.encode(), "part.cls", AS_WRITTEN)
    assert not faults and program is not None
    mist = next(each for each in program.events if each.kind is EventKind.COOLANT)
    program = replace(program, events=(replace(mist, value=2.0), *program.events))
    for number in (1, 2):
        side, _ = with_side(program, number)
        assert side is not None
        switched = [(each.row, each.value) for each in side.events if each.kind is EventKind.COOLANT]
        assert switched == [(0, 2), (0, 1), (len(side), 0)]


def test_the_wait_of_the_program_for_its_spindle_is_in_both_sides():
    program, faults = read_content(BOTH.encode(), "part.cls", AS_WRITTEN)
    assert not faults and program is not None
    modal = [each for each in program.events if each.row == 0]
    program = replace(program, events=(*modal, Event(0, EventKind.DWELL, 2.0), *program.events[len(modal) :]))
    for number in (1, 2):
        side, _ = with_side(program, number)
        assert side is not None
        kinds = [each.kind for each in side.events]
        assert kinds.index(EventKind.DWELL) > kinds.index(EventKind.SPINDLE)
        assert [(each.row, each.value) for each in side.events if each.kind is EventKind.DWELL] == [(0, 2.0)]


@pytest.mark.parametrize("side", [3, 100])
def test_a_side_that_there_is_not_is_refused(tmp_path, side):
    with pytest.raises(Refused, match=f"K153.*side {side} of 2 sides"):
        posted(tmp_path, BOTH, side=side)


@pytest.mark.slow
def test_a_program_without_half_turns_has_one_side(tmp_path):
    text = f"{HEAD}{UPPER}{TAIL}"
    whole, side = posted(tmp_path / "whole", text), posted(tmp_path / "side", text, side=1)
    assert statements(whole) == statements(side)
    with pytest.raises(Refused, match="side 2 of 1 side"):
        posted(tmp_path, text, side=2)


@pytest.mark.parametrize("text", ["0", "-1", "1.5", "two"])
def test_sides_are_counted_from_one(text):
    with pytest.raises(ValueError, match="the number of a side, from 1"):
        options_from(parse_text(f"--side={text}"))
