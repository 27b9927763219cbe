# SPDX-License-Identifier: LGPL-2.1-or-later
"""Constructs of Siemens's language and the motions they stand for, by its programming manuals.

[NC] is the manual of SiemensNC, [C] that of SiemensCycles, as docs/references.md has them; pages are theirs.
"""

import math

import numpy as np
import pytest

from pkm_post.model import Kind, Tool, errors
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.siemens import read

TOOL = Tool(0, "", 10.0, 0.0, 100.0)
HEAD = "G90 G17 G71 G94 G54 F600\nG0 X0 Y0 Z10\n"


def taken(text, **options):
    """Read a program, which is right, with its end."""
    program, diagnostics = read(text, "part.mpf", ReadOptions(default_tool=TOOL, **options))
    assert program is not None, "\n".join(map(str, diagnostics))
    assert not errors(diagnostics)
    return program


def moves(text, **options):
    """Kind and end point of the moves behind the first one."""
    program = taken(HEAD + text, **options)
    points = (tuple(point) for point in np.round(program.position[1:], 6).tolist())
    return [(Kind(kind).name[0], *point) for kind, point in zip(program.kind[1:].tolist(), points, strict=True)]


S = math.sqrt(0.5)
MOTIONS = {
    "words": ("G1 X=10 Y=-2.5\nX1EX1 Y=.5", "L 10 -2.5 10, L 10 0.5 10"),
    "run together": ("N10G1X1Y2F500", "L 1 2 10"),
    "increments": ("G1 X=IC(5) Y3\nG91 X5 Y=AC(1)\nG90 Z=IC(-1)", "L 5 3 10, L 10 1 10, L 10 1 9"),
    "comments": ('G1 X1 ; X2\nMSG("; X3")\n; X4\nG1 Y1', "L 1 0 10, L 1 1 10"),
    "inches": ("G70 G1 X1\nG71 X1", "L 25.4 0 10, L 1 0 10"),
    "R parameters": ("R1=2 R[R1+1]=R1*3\nG1 X=R1 Y=R3", "L 2 6 10"),
    "variables": ("DEF REAL AA=1.5, BB[2,2]\nBB[1,0]=AA+1\nG1 X=AA Y=BB[1,0]", "L 1.5 2.5 10"),
    # [NC] 3.1.3: POT is the square, ATAN2(30.5,80.1) is 20.8455 degrees
    "functions": (
        "G1 X=POT(3)+SQRT(4)-ABS(-1) Y=ROUND(10000*ATAN2(30.5,80.1))/10000 Z=10*SIN(30)\n"
        "X=TRUNC(-2.7) Y=ROUND(2.5) Z=7 MOD 4 + 7 DIV 2",
        "L 10 20.8455 5, L -2 3 6",
    ),
    "if": ("R1=3\nIF R1==3\nG1 X1\nELSE\nG1 X2\nENDIF\nIF R1<>3\nG1 X3\nELSE\nG1 X4\nENDIF", "L 1 0 10, L 4 0 10"),
    "jumps": (
        "R1=0\nAGAIN: R1=R1+1\nG1 X=R1\nIF R1<2 GOTOB AGAIN\nGOTOF N90\nG1 X99\nN90 G1 Y1",
        "L 1 0 10, L 2 0 10, L 2 1 10",
    ),
    # [SiemensNC, program jumps]: main blocks begin with a colon, and are destinations as the others are
    "to a main block": ("GOTOF :90\nN90 G1 X1\n:090 G1 X2\nGOTOF N90\nG1 X3\n/N90 X4", "L 2 0 10, L 4 0 10"),
    "case": ("R1=2\nCASE R1 OF 1 GOTOF AA 2 GOTOF BB DEFAULT GOTOF AA\nAA: G1 X1\nBB: G1 X2", "L 2 0 10"),
    "loops": (
        "G1\nFOR R1=1 TO 3\nX=R1\nENDFOR\nWHILE R1>2\nR1=R1-1\nY=R1\nENDWHILE\nREPEAT\nR1=R1+1\nZ=R1\n"
        "UNTIL R1>=4",
        "L 1 0 10, L 2 0 10, L 3 0 10, L 3 3 10, L 3 2 10, L 3 2 3, L 3 2 4",
    ),
    "loop left": (
        "R1=0\nG1\nLOOP\nR1=R1+1\nX=R1\nIF R1==2 GOTOF OUT\nENDLOOP\nOUT: Y1",
        "L 1 0 10, L 2 0 10, L 2 1 10",
    ),
    # [NC] 3.1.9, program section repetition
    "repeat to here": ("G1 G91\nAA: X1\nREPEAT AA P=2", "L 1 0 10, L 2 0 10, L 3 0 10"),
    "repeat a block": ("G1 G91\nAA: X1\nY1\nREPEATB AA P=2", "L 1 0 10, L 1 1 10, L 2 1 10, L 3 1 10"),
    "repeat a section": (
        "G1 G91\nAA: X1\nBB: Y1\nZ1\nREPEAT AA BB P=1",
        "L 1 0 10, L 1 1 10, L 1 1 11, L 2 1 11, L 2 2 11",
    ),
    "circle by centre": ("G1 X10\nG2 X20 Y10 I10 J0\nG3 X10 Y0 I=AC(20) J=AC(0)", "L 10 0 10, A 20 10 10, A 10 0 10"),
    "circle by radius": ("G2 X10 Y10 CR=10\nG3 X0 Y0 CR=-10", "A 10 10 10, A 0 0 10"),
    "distances after a circle by angle": ("G2 I5 J0 AR=90\nG1 X=IC(1) Y=IC(2)", "A 5 5 10, L 6 7 10"),
    "circle by angle": ("G3 X10 Y10 AR=90\nG3 I0 J10 AR=180", "A 10 10 10, A 10 30 10"),
    "circle by angle and coordinates of its centre": (
        "G1 X5 Y4\nG3 I=AC(10) J=AC(4) AR=90\nG3 I0 J=AC(4) AR=180",
        "L 5 4 10, A 10 -1 10, A 10 9 10",
    ),
    "coordinates among increments": (
        "G 91 G1 X5\nX=AC(7)\nG=90 X1\nG=91 X1\nX=AC(9)",
        "L 5 0 10, L 7 0 10, L 1 0 10, L 2 0 10, L 9 0 10",
    ),
    "turns": ("G3 X0 Y0 Z7 I10 J0 TURN=2", "A 0 0 9, A 0 0 8, A 0 0 7"),
    # 802D sl, 06/2006, p. 157: the circle of that example has its centre in (40, 32.5)
    "CIP": ("G1 X30 Y40\nCIP X50 Y40 I1=40 J1=45", "L 30 40 10, A 50 40 10"),
    "CIP in increments": ("G1 X30 Y40\nG91 CIP X20 Y0 I1=10 J1=5", "L 30 40 10, A 50 40 10"),
    "CT": ("G1 X20\nCT X30 Y10\nCT X30 Y20", "L 20 0 10, A 30 10 10, L 30 20 10"),
    "shift": ("TRANS X10 Y5\nG1 X0 Y0\nATRANS X1\nX0\nTRANS\nX0", "L 10 5 10, L 11 5 10, L 0 5 10"),
    # [NC] 2.12.5: ROT turns about Z, then about the new Y, then about the new X; absolute statements replace each other
    "turn in the plane": ("TRANS X10\nAROT RPL=90\nG1 X5 Y0\nROT\nG1 X5 Y0", "L 10 5 10, L 5 0 10"),
    "turn": ("ROT Z90 X90\nG1 X1 Y2 Z3\n", "L 3 1 2"),
    "scale and mirror": (
        "SCALE X2\nG1 X5\nMIRROR X0\nX5\nAMIRROR Y0\nY1 X0\nMIRROR\nG1 Y1",
        "L 10 0 10, L -5 0 10, L 0 -1 10, L 0 1 10",
    ),
    "planes": ("G18 G2 X10 Z0 I0 K-10", "A 10 0 0"),
    # [C] 2.1: RFP + SDIS rapidly, the depth with feed, RTP rapidly
    "CYCLE81": ("X5\nCYCLE81(20,0,2,-10)", "R 5 0 10, R 5 0 2, L 5 0 -10, R 5 0 20"),
    "depth relative": ("CYCLE82(20,1,2,,11,0.5)", "R 0 0 3, L 0 0 -10, R 0 0 20"),
    "CYCLE85": ("CYCLE85(20,0,2,-10,,,300,900)", "R 0 0 2, L 0 0 -10, L 0 0 2, R 0 0 20"),
    "chips broken": (
        "CYCLE83(20,0,2,-12,,-5,,1,0,0,1,0)",
        "R 0 0 2, L 0 0 -5, L 0 0 -4, L 0 0 -9, L 0 0 -8, L 0 0 -12, R 0 0 20",
    ),
    "one stroke": ("CYCLE83(20,0,2,-9,,,0)", "R 0 0 2, L 0 0 -9, R 0 0 20"),
    "chips removed": (
        "CYCLE83(20,0,2,-9,,-5,,0,0,0,1,1)",
        "R 0 0 2, L 0 0 -5, R 0 0 2, R 0 0 -4.4, L 0 0 -9, R 0 0 20",
    ),
    "MCALL": (
        "MCALL CYCLE81(20,0,2,-1)\nG0 X5\nX6\nMCALL\nX7",
        "R 5 0 10, R 5 0 2, L 5 0 -1, R 5 0 20, R 6 0 20, R 6 0 2, L 6 0 -1, R 6 0 20, R 7 0 20",
    ),
    "HOLES1": (
        "MCALL CYCLE81(20,0,2,-1)\nHOLES1(1,0,90,2,3,2)\nMCALL",
        "R 1 2 10, R 1 2 2, L 1 2 -1, R 1 2 20, R 1 5 20, R 1 5 2, L 1 5 -1, R 1 5 20",
    ),
    "HOLES2": (
        "MCALL CYCLE81(20,0,2,-1)\nHOLES2(0,0,10,0,0,2)\nMCALL",
        "R 10 0 10, R 10 0 2, L 10 0 -1, R 10 0 20, R -10 0 20, R -10 0 2, L -10 0 -1, R -10 0 20",
    ),
    "swivel": (
        'CYCLE800(1,"",0,57,10,0,0,0,90,0,0,0,0,-1)\nG0 X0 Y0\nZ5\nG1 X1\nCYCLE800()\nG0 X0 Y0 Z20',
        "R 15 0 0, L 15 0 -1, R 0 0 20",
    ),
    "machine": ("G0 SUPA Z0 D0\nD1\nG1 X1", "R 0 0 300, L 1 0 300"),
}  # fmt: skip
"""By name, a program and its moves: R, L or A for rapid moves, lines and arcs, with X Y Z."""


@pytest.mark.parametrize("name", MOTIONS)
def test_motions(name):
    text, expected = MOTIONS[name]
    wanted = [(kind, *map(float, point)) for kind, *point in (each.split() for each in expected.split(", "))]
    assert moves(text, machine_zero=(0.0, 0.0, 300.0)) == wanted


def test_arcs_have_the_centres_of_the_manual():
    program = taken(HEAD + "G1 X30 Y40\nCIP X50 Y40 I1=40 J1=45\nG1 X20 Y0\nG91 G1 X1\nG90 CT X31 Y10")
    centres = program.arc_centre[program.kind == Kind.ARC]
    assert np.allclose(centres, [(40, 32.5, 10), (21, 10, 10)])
    assert np.allclose(program.arc_axis[program.kind == Kind.ARC], [(0, 0, -1), (0, 0, 1)])


AXES = {
    "vector": ("TRAORI\nG1 X1 A3=1 B3=0 C3=1", (S, 0, S)),
    "vector without zeros": ("TRAORI\nG1 X1 A3=1", (1, 0, 0)),
    "vector in a turned frame": ("TRAORI\nROT Z90\nG1 X1 A3=1 C3=1", (0, S, S)),
    "RPY": ("TRAORI ORIRPY\nG1 X1 A2=0 B2=45 C2=90", (0, S, S)),
    "Euler": ("TRAORI ORIEULER\nG1 X1 A2=90 B2=45", (S, 0, S)),
    "rotary": ("TRAORI\nG1 X1 A=90 C=90", (1, 0, 0)),
    "shortest": ("TRAORI\nG1 X1 A=DC(90) C=DC(90)", (1, 0, 0)),
    "rotary increments": ("TRAORI\nG1 X1 A=30 C=90\nA=IC(60) C90", (1, 0, 0)),
    "swivelled": ('CYCLE800(1,"",0,57,0,0,0,0,45,0,0,0,0,-1)\nG0 X1 Y0 Z0', (S, 0, S)),
    "kept": ("TRAORI\nG1 X1 A3=1 C3=1\nROT Z90\nG1 X2", (S, 0, S)),
}


@pytest.mark.parametrize("name", AXES)
def test_tool_axes(name):
    text, axis = AXES[name]
    assert np.allclose(taken(HEAD + text, axis_words="AC").tool_axis[-1], axis)


def test_a_swivelled_plane_is_turned_axis_by_axis_in_the_order_of_mode():
    """57 is X, Y, Z and 27 is Z, Y, X [C] CYCLE800: bits 0 and 1 are the axis of _A."""
    by_xyz, by_zyx = (
        taken(HEAD + f'CYCLE800(1,"",0,{mode},0,0,0,{angles},0,0,0,-1)\nG0 X1 Y0 Z0').position[-1]
        for mode, angles in ((57, "0,45,90"), (27, "90,45,0"))
    )
    assert np.allclose(by_xyz, (0, 1, 0))
    assert np.allclose(by_zyx, (0, S, -S))


def test_feeds():
    program = taken(HEAD + "G1 X1 F1200\nX2 FB=60\nX3\nG93 X4 F30\nG95 S1000 M3 F0.1\nX5\nG700 G94 F10\nX6\nM5")
    assert np.allclose(program.feed[1:], [20, 1, 20, 0.5, 100 / 60, 254 / 60])


def test_a_turn_in_place_takes_the_time_of_its_block():
    text = "TRAORI\nG93 G1 X6 F5\nA3=1 C3=1 F5\nA3=1 C3=0 F10\nX0 A3=0 C3=1 F2"
    assert np.allclose(taken(HEAD + text, axis_words="vector").feed[1:], [0.5, 45 * 5 / 60, 45 * 10 / 60, 6 * 2 / 60])


@pytest.mark.parametrize("frame", ["TRANS X10", "ATRANS X10 Y1", "ROT RPL=30", "MIRROR X0", "SCALE X2 Y2"])
@pytest.mark.parametrize("move", ["X=IC(5)", "G91 X5", "Y=AC(3)\nX=IC(5)"])
def test_distances_after_a_new_frame_are_refused_where_setting_data_decide(frame, move):
    text = f"{HEAD}G1 X4 Y2 F600\n{frame}\n"
    program, faults = read(text + move + "\nM30\n", "part.mpf", ReadOptions(default_tool=TOOL))
    assert program is None
    assert [each.code for each in faults] == ["G602"] and "X by distances" in faults[0].found
    taken(f"{text}X4\n{move}\nM30\n")  # G90 has set X in the new frame
    taken(f"{HEAD}G1 X4 Y2 F600\nTRANS Z5\n{move}\nM30\n")  # X is where it was


def test_the_feed_of_g70_stays_in_mm():
    """[NC] G70 changes lengths alone, G700 feeds as well."""
    assert np.allclose(taken(HEAD + "G70 G1 X1 F600\nG700 X2 F1").feed[1:], [10, 25.4 / 60])


def test_a_feed_goes_on_in_another_unit():
    """Basic Functions 828D, 09/2011, 6FC5397-0BP40-2BA0, p. 341: it remains active after G700 and G710."""
    assert np.allclose(taken(HEAD + "G1 X1\nG700 X2\nG710 X3 F60\nG70 X4").feed[1:], [10, 10, 1, 1])
    head = "G700 G90 G94 G54\nG0 X0 Y0 Z1\n"
    assert np.allclose(taken(head + "G1 X1\nX2 F1", feed=2.0).feed[1:], [2, 25.4 / 60])


@pytest.mark.parametrize("unit", ["G71", "G70", "G700", "G700 F1\nG71"])
def test_a_thread_has_the_speed_of_its_call_in_any_unit(unit):
    """[C] CYCLE84: SST and SST1 are speeds of the spindle; the lead is 1 mm."""
    text = f"{unit}\nG90 G54 S100 M3\nG0 X0 Y0 Z10\nCYCLE84(10,0,2,-2,,,3,,1,0,120,240,,1)"
    assert np.allclose(taken(text, spindle_axis=True).feed[[2, 3]], [2.0, 4.0])


def test_events():
    text = 'T="MILL 8" D1\nM6\nS500 M3 M8\nG0 X1\nG4 F2\nG4 S10\nM1\nG1 X2\nM30'
    events = [(event.row, event.kind, event.value) for event in taken(HEAD + text).events]
    names = [(row, kind.name, value) for row, kind, value in events]
    assert names == [
        (1, "TOOL_CHANGE", 1), (1, "SPINDLE", 500), (1, "COOLANT", 1), (2, "DWELL", 2), (2, "DWELL", 1.2),
        (2, "STOP", 1), (3, "SPINDLE", 0), (3, "COOLANT", 0),
    ]  # fmt: skip


def test_a_tool_change_leaves_the_spindle_stopped_until_it_is_started():
    text = 'T="MILL 8" D1\nM6\nS500 M3\nG1 X1 F60\nM6\nS900\nX2\n{}X3\nM30'
    speeds = [
        [(event.row, event.value) for event in taken(HEAD + text.format(again)).events if event.kind.name == "SPINDLE"]
        for again in ("", "M4\n")
    ]
    assert speeds == [[(1, 500), (4, 0)], [(1, 500), (3, -900), (4, 0)]]


def test_tools_by_name_get_free_numbers_and_the_report_says_so():
    program = taken(
        HEAD + 'T1\nM6\nG1 X1\nT="MILL"\nM6\nX2\nT="DRILL"\nM6\nX3', tools={3: Tool(3, "Drill", 5.0, 0.0, 80.0)}
    )
    assert [event.value for event in program.events] == [1, 2, 3]
    assert [line for line in program.reading if "tool" in line] == ['tool "MILL" is number 2 here']
    assert (program.tools[2].name, program.tools[3].diameter) == ("MILL", 5.0)


def test_without_m6_t_changes_the_tool():
    assert [event.value for event in taken(HEAD + "T5 D1\nG1 X1").events] == [5]


@pytest.mark.parametrize(
    ("text", "tolerance"),
    [
        ("CYCLE832(0.05,1,1)", 0.05), ("CYCLE832(0.05,_ORI_ROUGH,0.8)", 0.05), ("CYCLE832(0.05,1)\nCYCLE832()", 0),
        ("CYCLE832(0.05,1)\nCYCLE832(0,_OFF,1)", 0), ("CTOL=0.02 G642", 0.02), ("CTOL=0.02 COMPCAD", 0.02),
        ("CTOL=0.02", 0), ("CTOL=0.02 G642\nCTOL=-1", 0), ("CTOL=0.02 G642\nG60", 0),
    ],
)  # fmt: skip
def test_tolerances(text, tolerance):
    assert taken(HEAD + text + "\nG1 X1").tip_tolerance[-1] == tolerance


def test_exact_stops():
    assert taken(HEAD + "G1 X1\nG60 X2\nX3\nG64 X4\nG9 X5\nX6").exact_stop[1:].tolist() == [
        False,
        True,
        True,
        False,
        True,
        False,
    ]
    in_machine = taken(HEAD + "G9 G1 SUPA X1\nX2\nSUPA X3", machine_zero=(0.0, 0.0, 0.0))
    assert in_machine.exact_stop[1:].tolist() == [True, False, False]


def test_cutter_compensation_and_mirrored_arcs():
    program = taken(HEAD + "T1\nG1 G41 X5\nG2 X10 Y5 CR=5\nG1 G40 X20\nMIRROR X0\nG2 X-15 Y10 CR=5\nG1 G42 X30")
    assert program.side_offset[1:].tolist() == [5, 5, 0, 0, 5]
    assert program.arc_axis[program.kind == Kind.ARC, 2].tolist() == [-1, 1]


ARCHIVE = """%_N_MAIN_MPF
;$PATH=/_N_MPF_DIR
G90 G54 F600
G0 X0 Y0 Z10
L10 P2
STEP(3, 1.5)
G1 Y9
M30
%_N_L10_SPF
G91 G1 X1
G90
M17
%_N_STEP_SPF
PROC STEP(INT COUNT, REAL WIDTH, REAL HIGH=7)
DEF INT NO
FOR NO=1 TO COUNT
G1 X=IC(WIDTH)
ENDFOR
Z=HIGH
RET
"""


def test_subprograms_of_an_archive():
    program = taken(ARCHIVE, needs_end=True)
    assert program.position[:, 0].tolist() == [0, 1, 2, 3.5, 5, 6.5, 6.5, 6.5]
    assert program.position[-1].tolist() == [6.5, 9, 7]
    assert program.line.tolist() == [4, 10, 10, 17, 17, 17, 19, 7]


def test_blocks_that_begin_with_a_slash():
    text = HEAD + "G1 X1\n/G1 X2\nN5 /1 G1 X3"
    assert len(taken(text)) == 4
    assert len(taken(text, block_delete=True)) == 2
    for levels, places in (((0,), [3]), ((1,), [2]), ((0, 1), []), ((2,), [2, 3])):
        program = taken(text + "\n/0 G1 Y4", block_delete=levels)
        assert program.position[2:, 0].tolist() == places + ([] if 0 in levels else [places[-1]])


def test_what_has_no_effect_is_listed_with_its_reason():
    lines = taken(HEAD + "FFWON SOFT\nFGROUP(X,Y,Z)\nFGREF[A]=10\nG601 G1 X1\nG603").reading
    assert [line.split(":")[0] for line in lines] == ["FFWON", "SOFT", "FGROUP", "FGREF", "G601", "G603"]
    assert lines[0].endswith("(line 3)")


def test_lines_one_by_one_and_lines_in_a_loop_are_the_same():
    """Plain lines go through columns, computed ones through the buffer."""
    text = "\n".join(f"G1 X{k}.5 Y{k} A3=0.{k} C3=1 F{100 + k}" for k in range(1, 9))
    other = "FOR R1=1 TO 8\nG1 X=R1+0.5 Y=R1 A3=R1/10 C3=1 F=100+R1\nENDFOR"
    one, two = (taken(f"{HEAD}TRAORI\n{each}") for each in (text, other))
    for name in ("position", "tool_axis", "feed"):
        assert np.allclose(getattr(one, name), getattr(two, name), equal_nan=True, rtol=0, atol=1e-12)
