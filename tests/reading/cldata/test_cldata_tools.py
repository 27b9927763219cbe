# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shape of the tool as CUTTER and TLDATA give it."""

import math

import pytest

from pkm_post.model import Tool
from pkm_post.reading.cldata import ReadOptions, read

BODY = "LOADTL/1,LENGTH,100\nFEDRAT/600,MMPM\nGOTO/0,0,0\nGOTO/10,0,0\nFINI\n"


def tool_and_codes(statement, unit="MM"):
    program, diagnostics = read(f"UNITS/{unit}\n{statement}\n{BODY}".encode(), "part.cls", ReadOptions())
    return (None if program is None else program.tools[1]), [item.code for item in diagnostics]


def shape(tool):
    return tool.diameter, tool.corner_radius, math.degrees(tool.bottom_angle), math.degrees(tool.side_angle)


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("CUTTER/10", (10, 0, 0, 0)),
        ("CUTTER/20,4,6,4,0,0,60", (20, 4, 0, 0)),
        ("CUTTER/6.,0,3.,1.802582,31.,0.", (6, 0, 31, 0)),  # a drill of an NCL user
        ("CUTTER/14.,7.,0,7.,0,0,73.", (14, 7, 0, 0)),  # a ball of SolidWorks
        ("CUTTER/10,2,3.3218,2,0,10,40", (10, 2, 0, 10)),
        ("CUTTER/10,1,4,2.10707,15,0,40", (10, 1, 15, 0)),
        ("CUTTER/10,2,3.3218,2", (10, 2, 0, 0)),
        ("TLDATA/MILL,6.0000,3.0000,50.0000,0.0000,0.0000", (6, 3, 0, 0)),
        ("TLDATA/MILL,6.0000,1.0000,50.0000,5.0000,15.0000", (6, 1, 15, 5)),
        ("TLDATA/DRILL,MILL,6.0000,118.0000", (6, 0, 0, 0)),
    ],
)
def test_sizes_of_the_tool(statement, expected):
    tool, codes = tool_and_codes(statement)
    assert shape(tool) == pytest.approx(expected, abs=1e-9)
    assert codes == (["L418"] if statement == "CUTTER/10,2,3.3218,2" else [])


@pytest.mark.parametrize(
    ("statement", "known"),
    [
        ("CUTTER/10", False),
        ("CUTTER/10,0", True),
        ("CUTTER/10,5", True),
        ("$$-> CUTTER / 10.0", False),
        ("TLDATA/MILL,10,5,50,0,0", True),
        ("TLDATA/DRILL,MILL,6.0000,118.0000", False),
        ("TLDATA/BARREL,MILL,10,5,50,0,0", False),  # not a ball of radius 5
        ("PPRINT/none", False),
    ],
)
def test_a_diameter_alone_leaves_the_corner_open(statement, known):
    assert tool_and_codes(statement)[0].corner_known is known


def test_angles_stay_degrees_in_inches():
    tool, _ = tool_and_codes("CUTTER/1,0.1,0.4,0.13032,15,0,4", "INCHES")
    assert shape(tool) == pytest.approx((25.4, 2.54, 15, 0), abs=1e-9)


@pytest.mark.parametrize(
    "statement", ["CUTTER/10,6", "CUTTER/10,0,5,0,90,0", "CUTTER/10,0,5,0,45,45", "CUTTER/10,1,1,1,-1,0"]
)
def test_impossible_shapes_are_refused(statement):
    assert tool_and_codes(statement) == (None, ["L403"])


def test_ball_with_a_taper_is_larger_than_half_the_nominal_diameter():
    # d = 2 r tan(45 - b/2), where the corner's centre comes to the axis
    d = 2 * 3 * math.tan(math.radians(40))
    tool, codes = tool_and_codes(f"CUTTER/{d:.6f},3,0,3,0,10")
    assert shape(tool) == pytest.approx((d, 3, 0, 10), abs=1e-5)
    assert codes == []


# Gauge lengths


def lengths_and_codes(*changes, tools=None):
    text = "UNITS/MM\nFEDRAT/600,MMPM\nCUTTER/10\n"
    text += "".join(f"LOADTL/{change}\nGOTO/{step},0,0\nGOTO/{step},0,9\n" for step, change in enumerate(changes))
    program, diagnostics = read(f"{text}FINI\n", "part.cls", ReadOptions(tools=tools or {}))
    return {number: tool.length for number, tool in program.tools.items()}, [str(item) for item in diagnostics]


@pytest.mark.parametrize(
    ("statement", "length"),
    [  # the forms of CATIA (a compensation number second), PTC, NX and NCCS; other numbers are registers
        ("LOADTL/1", 0), ("LOADTL/1,2", 0), ("LOADTL/1,ADJUST,5", 0), ("LOADTL/1,LENGTH,60,ADJUST,5", 60),
        ("LOADTL/1,OSETNO,3,LENGTH,60", 60), ("LOAD/TOOL,1", 0), ("LOAD/TOOL,1,ADJUST,3,LENGTH,60.5", 60.5),
        ("TOOLNO/1,MILL,10,0,LENGTH,60", 60), ("LOADTL/TOOL,1", None), ("LOADTL/1.5", None), ("LOADTL/T1", None),
        ("LOAD/1", None), ("LOADTL/-1", None), ("LOADTL/1,LENGTH", None), ("LOADTL/1,LENGTH,ADJUST,5", None),
        ("LOADTL/1,LENGTH,60,LENGTH,90", None), ("LOADTL/1,ADJUST,1,SPINDL,1500,MILL", 0),
    ],
)  # fmt: skip
def test_forms_of_a_tool_change(statement, length):
    program, diagnostics = read(f"UNITS/MM\nFEDRAT/60\n{statement}\nGOTO/1,0,0\nFINI\n", "part.cl", ReadOptions())
    if length is None:
        assert (program, diagnostics[0].code[:2]) == (None, "L4")
    else:
        assert {number: tool.length for number, tool in program.tools.items()} == {1: length}
        assert [item.code for item in diagnostics] == ([] if length else ["L411"])


def test_the_length_of_the_tool_body_is_no_gauge_length():
    """HSMWorks' post for Generative Machining writes ``tool.bodyLength``, what stands out of the holder, there."""
    assert lengths_and_codes("1,IN,0,LENGTH,50,OSETNO,1")[0] == {1: 0}
    text = "UNITS/MM\nFEDRAT/60\nLOADTL/1, IN, 0, LENGTH, 50, OSETNO, 1\nGOTO/1,0,0\nFINI\n"
    _, diagnostics = read(text, "part.apt", ReadOptions())
    assert [(item.code, item.place.line) for item in diagnostics] == [("L411", 3), ("L450", 3)]


def test_a_tool_keeps_its_length_where_a_change_states_none():
    assert lengths_and_codes("1,LENGTH,100", "2,LENGTH,80", "1", "2") == ({1: 100, 2: 80}, [])
    assert lengths_and_codes("1,LENGTH,100", "2,LENGTH,80", "1,LENGTH,100") == ({1: 100, 2: 80}, [])
    assert lengths_and_codes("1", "2,LENGTH,80", "1,LENGTH,90") == ({1: 90, 2: 80}, [])


def test_the_length_of_the_default_tool_is_none_that_the_file_states():
    text = f"UNITS/MM\nCUTTER/10\nLOADTL/1\nGOTO/1,0,0\n{BODY}"
    program, diagnostics = read(text, "part.cls", ReadOptions(default_tool=Tool(0, "", 0, 0, 90)))
    assert (program.tools[1].length, [item.code for item in diagnostics]) == (100, [])


def test_of_several_lengths_of_a_tool_none_is_taken():
    lengths, (found,) = lengths_and_codes("1,LENGTH,100", "2,LENGTH,80", "1,LENGTH,95.5")
    assert lengths == {1: 0, 2: 80}
    assert "L443" in found
    assert "tool 1: 95.5, 100 mm" in found
    assert lengths_and_codes("1,LENGTH,100", "2,LENGTH,80", "1,LENGTH,95", tools={1: Tool(1, "", 10, 0, 70)}) == (
        {1: 70, 2: 80},
        [],
    )


@pytest.mark.parametrize(
    "statement", ["TLDATA/WEDM,0.2000,25.0000,0.0000", "TLDATA/TURN,0,0,1,0.8,20", "TLDATA/GROOVE,3"]
)
def test_tools_of_other_processes_are_refused_by_name(statement):
    """Their first number is no diameter: STEPNode of STEP Tools, ParseNX.js, lists their values."""
    assert tool_and_codes(statement)[1] == ["L401"]
