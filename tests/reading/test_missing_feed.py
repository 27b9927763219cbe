# SPDX-License-Identifier: LGPL-2.1-or-later
"""A feed that a part program does not state: refused, or as the user gives it."""

import numpy as np
import pytest

from pkm_post.model import Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading import cldata, gcode
from pkm_post.reading.part_program import ReadingOptions, read_content

CL_WITHOUT = "UNITS/MM\nLOADTL/1,LENGTH,60\nRAPID\nGOTO/0,0,9\nGOTO/0,0,0\n{}GOTO/9,0,0\nRAPID\nGOTO/9,0,9\nFINI\n"
CL_CYCLE = CL_WITHOUT.replace("GOTO/0,0,0\n", "CYCLE/DRILL,DEPTH,5,CLEAR,2\nGOTO/0,0,0\nCYCLE/OFF\n")
GCODE_WITHOUT = "G21\nG0 X0 Y0 Z9\nG1 Z0\n{}X9\nG0 Z9\nM2\n"


@pytest.mark.parametrize(
    ("text", "name", "stated", "code"),
    [
        (CL_WITHOUT, "a.apt", "FEDRAT/60,MMPM\n", "L407"),
        (CL_CYCLE, "a.apt", "FEDRAT/60,MMPM\n", "L412"),
        (GCODE_WITHOUT, "a.ngc", "F60 ", "G408"),
    ],
)
def test_the_feed_before_the_first_one_is_as_given(text, name, stated, code):
    content = text.format(stated).encode()
    program, diagnostics = read_content(content, name, ReadingOptions())
    assert (program, [fault.code for fault in errors(diagnostics)]) == (None, [code])
    program, _ = read_content(content, name, ReadingOptions(feed=5.0))
    assert np.unique(program.feed[~np.isnan(program.feed)]).tolist() == [1, 5]
    assert program.feed[np.flatnonzero(program.kind != Kind.RAPID)].tolist()[0] == 5
    assert any("300 mm/min, as the option says" in line for line in program.reading)


@pytest.mark.parametrize("head", ["G93\n", "G95 S100 M3\n", "F60\nG93\nG94\n"])
def test_it_is_for_feeds_a_minute_before_the_first_f(head):
    text = head + GCODE_WITHOUT.format("").replace("G21\n", "")
    program, diagnostics = read_content(text.encode(), "a.ngc", ReadingOptions(feed=5.0))
    assert (program, {fault.code for fault in errors(diagnostics)}) == (None, {"G408"})


@pytest.mark.parametrize("feed", [0.0, -1.0, float("nan"), float("inf")])
def test_a_feed_is_a_number_above_zero(feed):
    for options in (cldata.ReadOptions, gcode.ReadOptions):
        with pytest.raises(ValueError, match="feed"):
            options(feed=feed)
