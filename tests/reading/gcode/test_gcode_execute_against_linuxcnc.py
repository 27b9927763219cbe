# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution against LinuxCNC: the numbers are made by tests/oracles/make_gcode_execution.py."""

import json
from pathlib import Path

import numpy as np
import pytest
from by_block import scan_by_block
from executed import execute

CASES = json.loads((Path(__file__).parents[2] / "data" / "gcode_execution.json").read_text())
LAST_DECIMAL = 0.5001e-4  # rs274 prints four decimals
READABLE = [name for name, case in CASES.items() if case["positions"] is not None]
REFUSED = [name for name, case in CASES.items() if case["positions"] is None]


def positions(blocks):
    """X Y Z A B C after each block that moves, from words that are absolute."""
    moves = np.column_stack([blocks.word(letter) for letter in "XYZABC"])
    moves = moves[~np.isnan(moves).all(axis=1)]
    here, path = np.zeros(6), []
    for move in moves:
        here = np.where(np.isnan(move), here, move)
        path.append(here)
    return np.reshape(path, (-1, 6))


def test_there_are_cases():
    assert len(READABLE) > 25
    assert len(REFUSED) > 25


@pytest.mark.parametrize("name", READABLE)
def test_goes_where_linuxcnc_goes(name):
    blocks, faults = scan_by_block(CASES[name]["program"], name)
    assert faults == ()
    plain, faults = execute(blocks)
    assert faults == ()
    expected = np.reshape(CASES[name]["positions"], (-1, 6))
    np.testing.assert_allclose(positions(plain), expected, rtol=0, atol=LAST_DECIMAL)


@pytest.mark.parametrize("name", REFUSED)
def test_refuses_what_linuxcnc_refuses(name):
    blocks, faults = scan_by_block(CASES[name]["program"], name)
    if blocks is not None:
        plain, faults = execute(blocks)
        assert plain is None
    assert faults
