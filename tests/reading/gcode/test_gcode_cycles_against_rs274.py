# SPDX-License-Identifier: LGPL-2.1-or-later
"""Series of canned cycles against rs274, the interpreter of LinuxCNC 2.9.0~pre1 (Debian 12).

tests/data/cycles_rs274.json has programs made at random and what rs274 does with them: rapids, feeds, dwells and the
spindle, in mm, or null where it refuses. tests/oracles/cycles_rs274.py wrote it, and compares thousands by hand.
"""

import json
import sys
from pathlib import Path

import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ReadOptions, read

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "oracles"))

from cycles_rs274 import as_rs274, difference, ours  # noqa: E402

CASES = json.loads((ROOT / "data" / "cycles_rs274.json").read_text(encoding="utf-8"))
TAKEN = [case for case in CASES if case["rows"] is not None]
REFUSED = [case for case in CASES if case["rows"] is None]


def text_of(case):
    return as_rs274(case["program"]) if case["cam"] else case["program"]


def test_there_are_cases():
    assert len(CASES) == 250 and len(REFUSED) > 15
    text = "".join(case["program"] for case in TAKEN)
    for word in (
        "G73",
        "G81",
        "G82",
        "G83",
        "G85",
        "G86",
        "G89",
        "G91",
        "G98",
        "G99",
        "G18",
        "G19",
        "G20",
        " L3",
        "G92",
    ):
        assert text.count(word) > 5, word


@pytest.mark.slow
@pytest.mark.parametrize("case", TAKEN, ids=range(len(TAKEN)))
def test_same_motion(case):
    rows, faults = ours(text_of(case))
    assert rows is not None, faults
    assert difference(case["rows"], rows) == ""


@pytest.mark.parametrize("case", REFUSED, ids=range(len(REFUSED)))
def test_refuses_the_same(case):
    assert ours(text_of(case))[0] is None


def test_another_height_is_a_difference():
    rows = [list(row) for row in TAKEN[0]["rows"]]
    lowest = min(range(len(rows)), key=lambda row: rows[row][-1])
    rows[lowest][-1] -= 0.05
    assert difference(rows, ours(text_of(TAKEN[0]))[0])
    assert difference(TAKEN[0]["rows"][:-1], ours(text_of(TAKEN[0]))[0])


SERIES = {
    "G91 with G99 keeps the initial level": ("G91 G99 G81 X10 Z-20 R-48", "X10", "X10"),
    "G98 after G99 returns to it": ("G99 G81 X1 Z-5 R2", "X2", "G98 X3"),
}
HEIGHTS = {
    "G91 with G99 keeps the initial level": [50, 50, 2, -18, 2, 2, -18, 2, 2, -18, 2],
    "G98 after G99 returns to it": [50, 50, 2, -5, 2, 2, -5, 2, 50, 50, 2, -5, 50],
}
"""Z of the moves, by hand: never below R at rapid."""


@pytest.mark.parametrize("name", SERIES)
def test_the_initial_level_is_kept(name):
    rows, faults = ours("\n".join(["G21 F100", "G90 G0 X0 Y0 Z50", *SERIES[name], "M2"]))
    assert rows is not None, faults
    assert [row[3] for row in rows] == HEIGHTS[name]


def test_k_repeats_as_l_does():
    """Fanuc has K for the number of repeats; rs274 has L alone."""
    head, hole = "G21 F100\nG90 G0 X0 Y0 Z50.\n", "G91 G99 G81 X10. Z-20. R-48."
    assert ours(f"{head}{hole} K3\nM2")[0] == ours(f"{head}{hole} L3\nM2")[0] is not None
    assert [fault.code for fault in ours(f"{head}{hole} K3 L3\nM2")[1]] == ["G418"]
    assert [fault.code for fault in ours(f"{head}{hole} K2.5\nM2")[1]] == ["G418"]
    assert [fault.code for fault in ours(f"{head}G1 X5. K3\nM2")[1]] == ["G404"]


@pytest.mark.parametrize("block", ["G0 G80 X5", "G80 G0 X5", "G0 G17 G40 G49 G80 G90\nX5", "G80\nG0 X5"])
def test_g80_beside_another_motion_leaves_it(block):
    """rs274 takes them all, and so do controls that have G80 in a group of its own."""
    rows, faults = ours(f"G21 F100\nG90 G0 X0 Y0 Z50\nG99 G81 X1 Z-5 R2\n{block}\nM2")
    assert rows is not None, faults
    assert rows[-1] == [0, 5, 0, 2]


@pytest.mark.parametrize("block", ["G80 G81 X5", "G81 G80 X5", "G80 G83 X5 Z-5 R2 Q1"])
def test_g80_beside_a_cycle_is_refused(block):
    """rs274 goes on with the cycle; where the last code of a group counts, G80 would end it."""
    rows, faults = ours(f"G21 F100\nG90 G0 X0 Y0 Z50\nG99 G81 X1 Z-5 R2\n{block}\nM2")
    assert rows is None and "G403" in {fault.code for fault in faults}


@pytest.mark.parametrize(
    "lines",
    [
        ["G90 G99 G81 X1 Z-5 R2", "G91 X10 L3"],
        ["G91 G99 G81 X1 Z-5 R-40", "G90 X10"],
        ["G90 G99 G81 X1 Z-5 R2", "G91 X10 R-40"],
        ["G90 G99 G81 X1 Z-5 R2", "G20", "X10"],
        ["G90 G99 G81 X1 Z-5 R2", "G18 X10"],
        ["G90 G99 G81 X1 Z-5 R2", "G18 G82 X10 Y-5 R2 P1"],
        ["G90 G98 G81 X1 Z-5 R2", "G92 Z0", "X10"],
        ["G91 G99 G81 X1 Z-5 R-40", "G52 Z5", "X10"],
    ],
)
def test_words_in_force_with_two_meanings_are_refused(lines):
    """rs274 takes the numbers for what they would mean now; a program may as well mean the heights they had."""
    rows, faults = ours("\n".join(["G21 F100", "G90 G0 X0 Y0 Z50", *lines, "M2"]))
    assert rows is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("G426", len(lines) + 2)]


@pytest.mark.parametrize(
    "lines",
    [
        ["G90 G99 G81 X1 Z-5 R2", "G91 X10 Z-7 R-48 L3", "G90 X3 R2 Z-5"],
        ["G90 G99 G81 X1 Z-5 R2", "G20", "X10 Z-0.2 R0.1"],
        ["G90 G99 G81 X1 Z-5 R2", "G80", "G18 G81 X10 Y-5 R2"],
        ["G90 G98 G81 X1 Z-5 R2", "G92 X0", "X10"],
        ["G90 G99 G81 X1 Z-5 R2", "G52 Z5", "X10"],
    ],
)
def test_the_cure_helps(lines):
    rows, faults = ours("\n".join(["G21 F100", "G90 G0 X0 Y0 Z50", *lines, "M2"]))
    assert rows is not None, faults


LEANS = "G21 F100\nG0 X0 Y0 Z50\nG43.5 H1 G0 I{:.7f} J{:.7f} K{:.7f}\n"


def of_leaning_tool(vector, hole):
    tool = Tool(1, "drill", 5.0, 0.0, 60.0)
    options = ReadOptions(tools={1: tool}, default_tool=tool, axis_words="vector")
    program, faults = read(f"{LEANS.format(*vector)}{hole}\nG80\nG0 I0 J0 K1\nM2\n", "part.ngc", options)
    return program, [(fault.code, fault.place.line) for fault in faults]


@pytest.mark.parametrize(
    ("vector", "hole"),
    [
        ((0, 0, 1), "G81 X1 Z-1 R5"),
        ((1e-7, 0, 1), "G81 X1 Z-1 R5"),
        ((0, 1, 0), "G18 G81 X1 Y-1 R5"),
        ((-1, 0, 0), "G19 G81 Y1 X-1 R5"),
    ],
)
def test_holes_are_drilled_along_the_tool(vector, hole):
    program, diagnostics = of_leaning_tool(vector, hole)
    assert program is not None and diagnostics == []


@pytest.mark.parametrize(
    ("vector", "hole"),
    [
        ((0, 0.6, 0.8), "G81 X1 Z-1 R5"),
        ((1e-5, 0, 1), "G81 X1 Z-1 R5"),
        ((0, 1, 0), "G81 X1 Z-1 R5"),
        ((0, 1, 0), "G19 G81 Y1 X-1 R5"),
    ],
)
def test_a_leaning_tool_is_not_plunged_sideways(vector, hole):
    """CAM operations refuse it as well (J122): a drill would go into the part beside its point."""
    assert of_leaning_tool(vector, hole) == (None, [("G429", 4)])
