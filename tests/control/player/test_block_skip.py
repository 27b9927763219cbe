# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks behind ``/``, read or skipped as the operator wants it while the program is played."""

import numpy as np
import pytest
from playing import TOLERANCES, TOOL, Playing, distance
from programs import ON_PALLET
from station import MACHINE

from pkm_post.control.player.block_skip import chosen_parts, stretches
from pkm_post.control.player.orders import Order
from pkm_post.model import Tool
from pkm_post.reading import gcode
from pkm_post.toolpath.place import place

SOURCE = """G21 G90 G17 F3000
G0 X0 Y0 Z90
G1 X20
/ G1 Y10
/ M8
G1 X30
G1 Y20
G1 Z95
/ G91
G1 X2
G1 X3
"""


def read(is_skipped):
    options = gcode.ReadOptions(
        default_tool=Tool(0, "in the spindle", 6.0, 0.0, TOOL), flavour="rs274", block_delete=is_skipped
    )
    made, faults = gcode.read(SOURCE, "part.ngc", options)
    assert made is not None, faults
    trajectory, faults = place(made, MACHINE, ON_PALLET)
    assert trajectory is not None, faults
    return trajectory


WHOLE, SKIPPED = read(False), read(True)


def lines(skips, first=0):
    answers = iter(skips)
    found = []
    for made, part in chosen_parts(WHOLE, SKIPPED, first, lambda: next(answers)):
        found += made.line[part.first : part.end].tolist()
    assert next(answers, None) is None
    return found


def test_where_both_postings_differ():
    choices = [one for one in stretches(WHOLE, SKIPPED) if one.is_choice]
    assert [WHOLE.line[slice(*one.rows)].tolist() for one in choices] == [[4, 6, 7], [10, 11]]
    assert [SKIPPED.line[slice(*one.skipped)].tolist() for one in choices] == [[6, 7], [10, 11]]
    assert not any(one.is_choice for one in stretches(WHOLE, WHOLE))


def test_all_ways_through_the_program():
    assert lines([False, False]) == [2, 3, 4, 6, 7, 8, 10, 11]
    assert lines([True, True]) == lines([True, False]) == [2, 3, 6, 7, 8, 10, 11]
    assert lines([False], first=3) == [6, 7, 8, 10, 11]  # inside the first choice, which is made
    whole = [part for _, part in chosen_parts(WHOLE, None, 0, bool)]
    assert [part.first for part in whole] == sorted(part.first for part in whole)


@pytest.mark.slow
@pytest.mark.parametrize("skips", [False, True])
def test_it_is_switched_while_it_plays(skips):
    playing = Playing.of(WHOLE, at={2: [Order("skip", float(skips))]})
    done = playing.play(skipped=SKIPPED, block_skip=not skips)
    assert done.finished and done.log.holds and done.stops == 0
    made = SKIPPED if skips else WHOLE
    tips = playing.tips()
    assert distance(tips, np.vstack([made.start_tip, made.tip])).max() < TOLERANCES.tip
    assert np.abs(tips[-1] - made.tip[-1]).max() < 1e-3
    assert playing.wire.controller.variables.read("P", 7002) == (0 if skips else 1)  # M8
