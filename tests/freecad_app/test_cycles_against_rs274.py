# SPDX-License-Identifier: LGPL-2.1-or-later
"""Series of drilling cycles of CAM operations against rs274, by tests/data/cycles_rs274.json."""

import json
import sys
from pathlib import Path as FilePath

import Path
import pytest

from pkm_post.freecad_app.commands import read_commands

ROOT = FilePath(__file__).parents[1]
sys.path.insert(0, str(ROOT / "oracles"))

from cycles_rs274 import difference, rows_of  # noqa: E402

CASES = [case for case in json.loads((ROOT / "data" / "cycles_rs274.json").read_text(encoding="utf-8")) if case["cam"]]
CYCLES = ("G73", "G81", "G82", "G83", "G85", "G89")


def program_of(text):
    """The program of an operation, its cycles with a feed, and the faults."""
    lines = [line.strip() for line in text.splitlines() if line != "M2"]
    commands = [Path.Command(f"{line} F5" if line.startswith(CYCLES) else line) for line in lines]
    return read_commands(commands, "part.FCStd", "Drilling", start=(0.0, 0.0, 0.0))


def test_there_are_cases():
    assert len(CASES) == 70
    assert sum(case["rows"] is None for case in CASES) > 3


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_same_motion(case):
    program, faults = program_of(case["program"])
    if case["rows"] is None:
        assert program is None and {fault.code for fault in faults} == {"J122"}
    else:
        assert program is not None, faults
        assert difference(case["rows"], rows_of(program)) == ""
