# SPDX-License-Identifier: LGPL-2.1-or-later
"""One part programmed as G-code, as CL data and as a FreeCAD job gives one and the same program."""

import numpy as np
import pytest
from cam_jobs import add_operation

from pkm_post.freecad_app.job import read_job
from pkm_post.model import Tool
from pkm_post.reading import cldata, gcode

SIX_DECIMALS = 1e-6

GCODE = """G21 G90 G17 G94
T1 M6
S9000 M3
G43.5
G0 X0 Y0 Z30 I0 J0 K1
G1 X0 Y0 Z5 I0 J0.6 K0.8 F1200
X10 Y4 Z5 I0.6 J0 K0.8 F1500
X20 Y4 Z5 I0 J0 K1
G49
G3 X20 Y24 I0 J10 F900
G0 Z30
M5
M2
"""

CLDATA = """UNITS/MM
CUTTER/5
LOADTL/1
SPINDL/RPM,9000,CLW
MULTAX/ON
RAPID
GOTO/0,0,30,0,0,1
FEDRAT/1200,MMPM
GOTO/0,0,5,0,0.6,0.8
FEDRAT/1500,MMPM
GOTO/10,4,5,0.6,0,0.8
GOTO/20,4,5,0,0,1
FEDRAT/900,MMPM
CIRCLE/20,14,5,0,0,1,10
GOTO/20,24,5,0,0,1
RAPID
GOTO/20,24,30,0,0,1
SPINDL/OFF
FINI
"""

JOB = [
    "G0 X0 Y0 Z30 I0 J0 K1",
    "G1 X0 Y0 Z5 I0 J0.6 K0.8 F20",
    "G1 X10 Y4 Z5 I0.6 J0 K0.8 F25",
    "G1 X20 Y4 Z5 I0 J0 K1 F25",
    "G3 X20 Y24 I0 J10 F15",
    "G0 Z30",
]


@pytest.fixture
def programs(job):
    add_operation(job, JOB)
    tools = {1: Tool(1, "T1", 5.0, 0.0, 120.0)}
    found = (
        gcode.read(GCODE, "part.ngc", gcode.ReadOptions(tools=tools, axis_words="vector")),
        cldata.read(CLDATA, "part.cl", cldata.ReadOptions(hand="right")),
        read_job(job),
    )
    for program, diagnostics in found:
        assert program is not None, diagnostics
    return [program for program, _ in found]


@pytest.mark.parametrize("column", ["kind", "position", "tool_axis", "feed", "arc_centre", "arc_axis", "side_offset"])
def test_columns_are_equal(programs, column):
    first, *others = (getattr(program, column) for program in programs)
    for other in others:
        np.testing.assert_allclose(other, first, atol=SIX_DECIMALS)


def test_events_are_equal(programs):
    first, *others = ([(event.row, event.kind, event.value) for event in program.events] for program in programs)
    assert first
    for other in others:
        assert other == first
