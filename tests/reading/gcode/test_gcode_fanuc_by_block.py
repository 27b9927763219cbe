# SPDX-License-Identifier: LGPL-2.1-or-later
"""The flavour of Fanuc's controls against a second reader that takes a program word by word.

python3 tests/reading/gcode/test_gcode_fanuc_by_block.py [PROGRAMS]    compares thousands
"""

import sys
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

sys.path[:0] = [str(Path(__file__).resolve().parents[3]), str(Path(__file__).parent)]

from fanuc_reference import Control  # noqa: E402 - the path comes first
from random_fanuc import program  # noqa: E402

from pkm_post.model import EventKind, Tool  # noqa: E402
from pkm_post.reading.gcode import ReadOptions, read  # noqa: E402
from pkm_post.reading.gcode.flavours import FANUC, FLAVOURS  # noqa: E402

ZERO = (3.0, -4.0, 250.0)
ROUNDING = 1e-9
DWELL = 4
BY_PLANE = {"fanuc": FANUC._replace(may_drill_along_z=False)}
"""A control whose parameter 5101#0 lets cycles in G18 and G19 drill along the normal of the plane."""


def ours(text):
    """The rows of the reader as the second one has them, and its diagnostics."""
    options = ReadOptions(default_tool=Tool(0, "any", 6.0, 0.0, 50.0), machine_zero=ZERO, needs_end=True)
    with patch.dict(FLAVOURS, BY_PLANE):
        given, faults = read(text, "part.nc", options)
    if given is None:
        return None, faults
    rows, events = [], [event for event in given.events if event.kind is EventKind.DWELL]
    for row in range(len(given) + 1):
        rows += [[DWELL, event.value] for event in events if event.row == row]
        if row < len(given):
            rows.append([int(given.kind[row]), *given.position[row].tolist()])
    return rows, faults


def moved(rows):
    """The rows without moves of no length."""
    kept, here = [], np.full(3, np.inf)
    for kind, *values in rows:
        if kind != DWELL:
            if np.abs(here - values).max() < ROUNDING:
                continue
            here = np.array(values)
        kept.append([kind, *values])
    return kept


def difference(text):
    """Words for the first difference of the two readers, empty if there is none."""
    found, faults = ours(text)
    if found is None:
        return f"refused: {faults[0]}"
    one, other = moved(Control(text, ZERO).rows), moved(found)
    for row, (a, b) in enumerate(zip(one, other, strict=False)):
        if a[0] != b[0] or np.abs(np.subtract(a[1:], b[1:])).max() > ROUNDING:
            return f"row {row}: {b} where the second reader has {a}"
    return "" if len(one) == len(other) else f"{len(other)} rows where the second reader has {len(one)}"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(60))
def test_same_motions_and_dwells(seed):
    text = program(seed)
    assert difference(text) == "", text


def test_the_programs_have_what_they_are_for():
    text = "".join(program(seed) for seed in range(60))
    assert all(
        text.count(word) > 5
        for word in (
            "G80",
            "G16",
            "G28",
            "G53",
            "K0",
            "M98",
            "G5.1",
            "G4 X",
            "G20",
            "M99",
            "G51",
            "G65",
            "G66",
            "G2",
            "G3",
            "WHILE",
            "GOTO",
        )
    )


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    different = [(seed, why) for seed in range(count) if (why := difference(program(seed)))]
    print(f"{count} programs, {len(different)} different", *different[:5], sep="\n")
    sys.exit(bool(different))
