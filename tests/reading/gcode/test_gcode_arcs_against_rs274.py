# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs that nearly fit their end points against rs274, the interpreter of LinuxCNC 2.9.0~pre1, in mm and in inches.

tests/data/arcs_rs274.json has blocks made at random and whether rs274 takes them; tests/oracles/arcs_rs274.py wrote it.
"""

import json
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "oracles"))

from arcs_rs274 import is_ours  # noqa: E402

CASES = json.loads((ROOT / "data" / "arcs_rs274.json").read_text(encoding="utf-8"))


def test_there_are_cases():
    assert len(CASES) == 240
    for unit in ("G20", "G21"):
        taken = [case["taken"] for case in CASES if case["block"].startswith(unit)]
        assert 40 < sum(taken) < len(taken) - 30


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["block"])
def test_takes_the_same_arcs(case):
    assert is_ours(case["block"]) == case["taken"]
