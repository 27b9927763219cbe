# SPDX-License-Identifier: LGPL-2.1-or-later
"""2D compensation of G-code, against what rs274 of LinuxCNC 2.9 makes of it.

tests/data/side_rs274.json was made by tests/oracles/side_rs274.py, four decimals printed, with arcs round corners.
"""

import json
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from contour_programs import clearance, cutting_rows, samples

from pkm_post.model import Kind, Tool
from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3
CASES = json.loads((Path(__file__).parents[2] / "data" / "side_rs274.json").read_text(encoding="utf-8"))
OPTIONS = ReadOptions(default_tool=Tool(0, "", 0.0, 0.0, 0.0), work_offsets={"G54": (0.0, 0.0, 0.0, 0.0)})


@cache
def read_and_offset(text):
    given, faults = read(text.encode(), "part.ngc", OPTIONS)
    assert given is not None, faults
    return given, *offset_contours(given, OffsetOptions(corners="arc"))


def table(moves):
    """Moves as columns: kind, position, arc centre and axis, NaN where there is none."""
    rows = np.array([[*move, *[np.nan] * (10 - len(move))] for move in moves], dtype=float)
    return SimpleNamespace(kind=rows[:, 0], position=rows[:, 1:4], arc_centre=rows[:, 4:7], arc_axis=rows[:, 7:10])


def same(expected, moved):
    if expected.kind.tolist() != moved.kind.tolist():
        return False
    arc = moved.kind == Kind.ARC
    off = (expected.arc_centre - moved.arc_centre)[arc]
    off -= np.sum(off * moved.arc_axis[arc], axis=1)[:, None] * moved.arc_axis[arc]
    return (
        np.abs(expected.position - moved.position).max() < MICRON
        and np.abs(off).max(initial=0.0) < MICRON
        and np.abs((expected.arc_axis - moved.arc_axis)[arc]).max(initial=0.0) < MICRON
    )


@pytest.mark.slow
def test_contours_are_offset_as_by_rs274():
    compared = 0
    for case in CASES:
        _, moved, _ = read_and_offset(case["program"])
        if moved is None or case["moves"] is None:
            continue
        assert same(table(case["moves"]), moved), case["program"]
        np.testing.assert_allclose(moved.feed[1:], 5.0)
        compared += 1
    assert compared >= 200


def test_what_rs274_refuses_is_refused():
    refused = [case["program"] for case in CASES if case["moves"] is None]
    assert len(refused) > 10
    for text in refused:
        _, moved, faults = read_and_offset(text)
        assert moved is None
        assert {fault.code for fault in faults} == {"N202"}


@pytest.mark.slow
def test_what_is_refused_beyond_rs274_cuts_into_the_part():
    """rs274 looks at neighbours alone. Its own path, measured by closed forms, is too near there."""
    beyond = 0
    for case in CASES:
        given, moved, faults = read_and_offset(case["program"])
        if moved is not None or case["moves"] is None:
            continue
        assert "N204" in {fault.code for fault in faults}
        plane = int(given.plane[1])
        path = table(case["moves"])
        walls = cutting_rows(given)
        nearest = min(
            clearance(samples(path, row, 400), given, walls, plane).min() for row in range(2, len(path.kind) - 1)
        )
        assert nearest < np.abs(given.side_offset[1]) - MICRON, case["program"]
        beyond += 1
    assert beyond > 10
