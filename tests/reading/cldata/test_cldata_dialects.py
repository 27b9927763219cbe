# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small programs in each dialect, written for these tests, and what they mean."""

import numpy as np
import pytest

from pkm_post.geometry import arc_sweep
from pkm_post.model import EventKind, Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import DIALECTS, ReadOptions, detect_dialect, read

MICRON = 1e-3

CREO = """$$*          Pro/CLfile  Version 9.0 - 9.0.0.0
$$-> MFGNO / PART1
PARTNO / PART1
$$-> FEATNO / 7
MACHIN / UNCX01, 1
UNITS / MM
LOADTL / 3, LENGTH, 120.0
$$-> CUTTER / 8.000000
$$-> CSYS / 1.0, 0.0, 0.0, 0.0,  $
            0.0, 1.0, 0.0, 0.0,  $
            0.0, 0.0, 1.0, 0.0
SPINDL / RPM, 5000.0,  CLW
RAPID
GOTO / 10.0, 0.0, 5.0
FEDRAT / 600.0,  MMPM
CIRCLE / 0.0, 0.0, 5.0,  $
0.0, 0.0, 1.0,  10.0
GOTO / 0.0, 10.0, 5.0
GOTO / 0.0, 20.0, 5.0, $
0.0, 0.6, 0.8
FINI
"""
NX = """TOOL PATH/FINISH,TOOL,BALL6
TLDATA/MILL,6.0000,3.0000,50.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
$$ centerline data
PAINT/PATH
UNITS/MM
LOAD/TOOL,3
SPINDL/RPM,5000,CLW
RAPID
GOTO/10.0,0.0,5.0,0.0,0.0,1.0
FEDRAT/MMPM,600.0
CIRCLE/0.0,0.0,5.0,0.0,0.0,-1.0,10.0,0.06,0.5,6.0,0.0
GOTO/0.0,10.0,5.0
GOTO/0.0,20.0,5.0,0.0,0.6,0.8
END-OF-PATH
"""
CATIA = """$$ CATIA APT VERSION 1.0
$$*CATIA0
$$ Manufacturing Program.1
$$    1.00000    0.00000    0.00000  100.00000
$$    0.00000    1.00000    0.00000    0.00000
$$    0.00000    0.00000    1.00000    0.00000
PARTNO PART1
UNITS/MM
$$ OPERATION NAME : Contour.1
CUTTER/8,4
TOOLNO/3,MILL, 8.0,  4.0,$
100
SPINDL/ 5000.0,RPM,CLW
RAPID
GOTO  /   10.0,    0.0,    5.0
FEDRAT/  600.0,MMPM
AUTOPS
INDIRV/  0.0,  1.0,  0.0
TLON,GOFWD/ (CIRCLE/  0.0, 0.0, 5.0,$
  10.0),ON,(LINE/  0.0, 0.0, 5.0,$
  0.0, 10.0, 5.0)
MULTAX
GOTO  / 0.0, 20.0, 5.0, 0.0, 0.6, 0.8
FINI
"""
SOLIDWORKS = """PARTNO/1
UNIT/MM
INSERT/8MM BALL
CUTTER/8.,4.,0,4.,0,0,73.
LOAD/TOOL,3
CSI_SET_FLUTE_LENGTH/38.
SPINDL/5000,RPM,CLW
INSERT/Stock Size X10. Y20. Z5.
TRNTYP/WORLD,0,0,0
CSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0
RAPID/
GOTO/10.,0,5.
FEDRAT/600.,MMPM
CIRCLE/0,0,5.,0,0,1.
GOTO/0,10.,5.
GOTO/0,20.,5.,0,.6,.8
FINI
"""
CAMPLETE = """MACHIN/undefined
MODE/MILL
PARTNO/'1001'
PPRINT/'NEW SECTION'
CSI_TOOL_PATH/contour
CSI_SET_PATH_PARAM/TOOL_BREAK=ON
UNITS/MM
MULTAX/ON
MCS/1, 0, 0, $
0, 1, 0, $
0, 0, 1, $
0, 0, 0
CUTTER/8.0, 4.0, 0, 4.0, 0, 0, 30
CSI_SET_FLUTE_LENGTH/30.0
LOADTL/3, 0, 30, 1
SPINDL/RPM,5000,CLW
RAPID
GOTO/10.0, 0.0, 5.0
FEDRAT/600.0, MMPM
CIRCLE/0.0, 0.0, 5.0, 0.0, 0.0, -1.0, 10.0, 90.0, 0.0, 0.0, 0.0
GOTO/0.0, 10.0, 5.0
GOTO/0.0, 20.0, 5.0, 0.0, 0.6, 0.8
FINI
"""
MAKINO = """PPRINT/APTCL-SPEC,MAKINO-FF,1
PPRINT/BEGIN-SECTION,DEFINE
UNITS/MM
SET/MODE,ABSOL
LOAD/TOOL,3
SPINDL/RPM,5000,CLW
RAPID
GOTO/10.0,0.0,5.0,0.0,0.0,1.0
PPRINT/MOTION,CUT,FEDRAT,DEFAULT
FEDRAT/PERMIN,600
CIRCLE/0.0,0.0,5.0,-0.0,-0.0,-1.0,10.0,0.002,0.5,10.0,0.0
GOTO/0.0,10.0,5.0
GOTO/0.0,20.0,5.0,0.0,0.6,0.8
"""
APT = """PARTNO PART1
REMARK written by hand
UNITS/MM
CUTTER/8,4,0,4,0,0,60
LOADTL/3
SPINDL/5000,CLW
RAPID
GOTO/10,0,5
FEDRAT/600
MOVARC/0,0,5,0,0,-1,10,ANGLE,90
GOTO/0,10,5
MULTAX/ON
GOTO/0,20,5,0,.6,.8
FINI
"""
SAMPLES = {
    "creo": CREO, "nx": NX, "catia": CATIA, "solidworks": SOLIDWORKS, "camplete": CAMPLETE, "makino": MAKINO, "apt": APT
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(SAMPLES))
def test_every_dialect_says_the_same_part(name):
    assert set(SAMPLES) == set(DIALECTS)
    assert detect_dialect(SAMPLES[name]).name == name
    program, diagnostics = read(SAMPLES[name], name)
    assert not errors(diagnostics)
    assert program.kind.tolist() == [Kind.RAPID, Kind.ARC, Kind.LINE]
    assert program.position == pytest.approx(np.array([[10, 0, 5], [0, 10, 5], [0, 20, 5]]), abs=MICRON)
    assert program.tool_axis == pytest.approx(np.array([[0, 0, 1], [0, 0, 1], [0, 0.6, 0.8]]), abs=1e-9)
    assert program.arc_axis[1] == pytest.approx([0, 0, 1])
    assert program.feed[1:] == pytest.approx(10.0)  # 600 mm/min
    events = [(event.row, event.kind, event.value) for event in program.events]
    assert events == [(0, EventKind.TOOL_CHANGE, 3), (0, EventKind.SPINDLE, 5000)]
    assert list(program.tools) == [3]
    assert read(SAMPLES[name].replace("\n", "\r\n").encode(), name)[1] == diagnostics


def test_what_dialects_say_of_tools_and_operations():
    assert read(CREO, "creo")[0].tools[3].length == 120
    assert read(CREO, "creo")[0].operations[-1] == "FEATNO 7"
    assert read(NX, "nx")[0].tools[3].name == "BALL6"
    assert read(NX, "nx")[0].tools[3].corner_radius == 3
    assert read(NX, "nx")[0].operations[-1] == "FINISH"
    assert read(SOLIDWORKS, "sw")[0].tools[3].name == "8MM BALL"
    assert read(CATIA, "catia")[0].operations[-1] == "Contour.1"


TILTED = "FEDRAT/600.0, MMPM\nRAPID\nGOTO/0, 0, 15\nGOTO/20, 0, 0\nFINI\n"
FRAMES = {
    "camplete": "MCS/1, 0, 0, $\n0, .8, .6, $\n0, -.6, .8, $\n0, 10, 20\n",
    "apt": "MCSYS/ NUM, 1, POINT, 0, 10, 20, VECTOR, 1, 0, 0, VECTOR, 0, .8, .6\n",
}


@pytest.mark.parametrize("name", FRAMES)
def test_frames_of_autodesk_posts_are_those_of_sections_in_the_set_up(name):
    """Points are in the section: its axes and origin are written, and the first section may be tilted [Autodesk]."""
    text = f"UNITS/MM\nCUTTER/8\nLOADTL/3\n{FRAMES[name]}{TILTED}"
    program, diagnostics = read(text, name)
    assert not errors(diagnostics)
    assert detect_dialect(text).name == name
    assert program.position == pytest.approx(np.array([[0, 1, 32], [20, 10, 20]]), abs=MICRON)
    assert program.tool_axis == pytest.approx(np.array([[0, -0.6, 0.8]] * 2), abs=1e-9)


def test_a_second_work_offset_in_a_file_is_refused():
    other = FRAMES["apt"].replace("NUM, 1", "NUM, 2")
    text = f"UNITS/MM\nCUTTER/8\nLOADTL/3\n{FRAMES['apt']}GOTO/0, 0, 15\n{other}{TILTED}"
    assert [(fault.code, fault.found) for fault in errors(read(text, "part")[1])] == [
        ("L401", "MCSYS with the work offset 2 after 1")
    ]


@pytest.mark.parametrize(("after", "faults"), [("ZERO/1", []), ("ZERO/2", ["L401"]), ("ZERO", ["L402"])])
def test_zero_is_the_number_of_a_work_offset(after, faults):
    """As the post for CAMplete writes it in each section [Autodesk posts]."""
    text = f"UNITS/MM\nCUTTER/8\nLOADTL/3\nZERO/1\n{FRAMES['camplete']}GOTO/0, 0, 15\n{after}\n{TILTED}"
    assert [fault.code for fault in errors(read(text, "part")[1])] == faults


SLOT = "GOTO/20, -5, 0\nCIRCLE/20, 0, 0, 0, 0, -1, 5{}\nGOTO/20, 5, 0\n"


def test_half_turns_show_no_hand():
    """A counter-clockwise end of a slot, as posts for CAMplete write it: about -Z, so its middle is at X25."""
    head = "UNITS/MM\nCUTTER/8\nLOADTL/3\nFEDRAT/600.0, MMPM\nGOTO/0, -5, 0\n"
    end = SLOT.format(", 180, 0.0, 0.0, 0.0") + "FINI\n"
    assert [fault.code for fault in errors(read(head + end, "part")[1])] == ["L433"]
    left = read(
        head + FRAMES["camplete"].replace(".6", "0").replace(".8", "1").replace("10, 20", "0, 0") + end, "part"
    )[0]
    assert left.arc_axis[-1] == pytest.approx([0, 0, 1], abs=1e-9)
    for angle in (180, 360):
        stop = "20, 5, 0" if angle == 180 else "20, -5, 0"
        movarc = f"GOTO/20, -5, 0\nMOVARC/20, 0, 0, 0, 0, 1, 5, ANGLE, {angle}\nGOTO/{stop}\n"
        assert [fault.code for fault in errors(read(head + movarc + "FINI\n", "part")[1])] == ["L433"]
        shown = "MOVARC/20, 5, 0, 0, 0, 1, 5, ANGLE, 90\nGOTO/25, 5, 0\n"
        first = head + movarc + "GOTO/20, 0, 0\n" + shown + "FINI\n"
        assert read(first, "part")[0].arc_axis[2] == pytest.approx([0, 0, 1], abs=1e-9)


def test_a_dialect_and_a_hand_can_be_prescribed():
    other = read(NX, "nx", ReadOptions(hand="right"))[0]
    assert other.arc_axis[1] == pytest.approx([0, 0, -1])
    assert read(NX, "nx", ReadOptions(dialect="creo"))[0].arc_axis[1] == pytest.approx([0, 0, -1])
    voted = read(NX, "nx", ReadOptions(hand="vote"))[0]
    sweep = arc_sweep(voted.position[0], voted.position[1], voted.arc_centre[1], voted.arc_axis[1])
    assert sweep == pytest.approx(np.pi / 2)


@pytest.mark.parametrize(
    "wrong",
    [
        {"dialect": "x"},
        {"units": "m"},
        {"hand": "up"},
        {"goto_values": {9: ("x",)}},
        {"goto_values": {4: ("x", "y", "z", "i")}},
    ],
)
def test_impossible_options_are_refused(wrong):
    with pytest.raises(ValueError, match="expected"):
        ReadOptions(**wrong)


def test_reading_twice_gives_the_same():
    first, second = read(CATIA, "part")[0], read(CATIA, "part")[0]
    assert repr(first) == repr(second)
