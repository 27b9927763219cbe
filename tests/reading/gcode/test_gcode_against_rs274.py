# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reader against rs274, the interpreter of LinuxCNC 2.9.0~pre1 (Debian 12): moves of programs made at random.

tests/data/gcode_rs274.json has the programs and what rs274 makes of them; tests/oracles/gcode_rs274.py wrote it. It has
moves in all modes, arcs by centre and by radius in the three planes, cycles, inches, offsets of every kind, and single
blocks with whether rs274 takes them. It prints four decimals, of millimetres or inches. tests/data/arcs_rs274.json has
arcs that nearly fit their end points, in mm and in inches, and whether rs274 takes them; tests/oracles/arcs_rs274.py
wrote it.
"""

import json
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "oracles"))

from arcs_rs274 import is_ours  # noqa: E402
from gcode_rs274 import after_a_move, difference, ours  # noqa: E402

ROWS = json.loads((ROOT / "data" / "gcode_rs274.json").read_text(encoding="utf-8"))
CASES = [row for row in ROWS if "program" in row]
BLOCKS = [row for row in ROWS if "block" in row]
ARCS = json.loads((ROOT / "data" / "arcs_rs274.json").read_text(encoding="utf-8"))


def test_there_are_cases():
    assert len(CASES) == 24
    assert {row["accepted"] for row in BLOCKS} == {True, False}
    assert sum(len(case["moves"]) for case in CASES) > 500


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_same_moves(case):
    program, faults = ours(case["program"])
    assert program is not None, faults
    assert difference(case["moves"], program) == ""


@pytest.mark.slow
@pytest.mark.parametrize("row", BLOCKS, ids=lambda row: row["block"])
def test_takes_and_refuses_the_same_blocks(row):
    program, _ = ours(after_a_move(row["block"]))
    assert (program is not None) == row["accepted"]


def test_a_moved_point_is_a_difference():
    kind, place, feed, arc = CASES[0]["moves"][3]
    moves = [*CASES[0]["moves"][:3], [kind, [place[0] + 0.02, *place[1:]], feed, arc], *CASES[0]["moves"][4:]]
    assert difference(moves, ours(CASES[0]["program"])[0])


def test_there_are_arcs():
    assert len(ARCS) == 240
    for unit in ("G20", "G21"):
        taken = [case["taken"] for case in ARCS if case["block"].startswith(unit)]
        assert 40 < sum(taken) < len(taken) - 30


@pytest.mark.slow
@pytest.mark.parametrize("case", ARCS, ids=lambda case: case["block"])
def test_takes_the_same_arcs(case):
    assert is_ours(case["block"]) == case["taken"]
