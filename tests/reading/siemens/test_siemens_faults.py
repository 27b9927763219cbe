# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs in Siemens's language with a fault, each with its diagnostic: code, line, column and what was found."""

import pytest

from pkm_post.model import Severity, Tool
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, ExecutionLimits, ReadOptions
from pkm_post.reading.siemens import read

HEAD = "G90 G54 F600\nG0 X0 Y0 Z10\n"
FIRST = 3
"""The line behind the head."""
TOOL = Tool(0, "", 10.0, 0.0, 100.0)


def found(text, limits=DEFAULT_LIMITS, **options):
    """The program, and its diagnostics as code, line, column and what was found."""
    options = {"default_tool": TOOL} | options
    program, diagnostics = read(text, "part.mpf", ReadOptions(**options), limits)
    return program, [(each.code, each.place.line, each.place.column, each.found) for each in diagnostics]


FAULTS = {
    # malformed blocks
    "G1 X?": ("G101", 5, "'?'"),
    "G1 X": ("G201", 4, "X"),
    "G1 X1 X2": ("G202", 7, "X"),
    "G1 X=": ("G209", 6, "the end of the block instead of a value"),
    "G1 X=(1+2": ("G601", 10, "the end of the block instead of )"),
    "G1 X=" + 60 * "(" + "1" + 60 * ")": ("G211", 56, "more than 50 brackets within each other"),
    "R1=1 R2=2\nIF R1==1 AND R2==2 GOTOF AA\nAA:": ("G601", 6, "AND beside == without brackets"),
    "DEF FRAME F1": ("G602", 5, "DEF FRAME: only REAL, INT, BOOL, CHAR, STRING are read"),
    "FOR 1 TO 2\nENDFOR": ("G206", 5, "'1'"),
    # values
    "G1 X=R1": ("G301", 6, "R1"),
    "G1 X=WIDTH": ("G603", 6, "WIDTH"),
    "G1 X=1/0": ("G304", 7, "1 / 0"),
    "G1 X=SQRT(-1)": ("G305", 6, "SQRT of -1"),
    "G1 X=$P_UIFR[1]": ("G303", 6, "$P_UIFR"),
    'G1 X="A"': ("G606", 4, 'X="A"'),
    "DEF REAL AA[2]\nAA[2]=1": ("G606", 1, "AA[2] of [2]"),
    # flow
    "GOTOF AA": ("G604", 1, "GOTOF AA"),
    "AA: GOTOF AA": ("G604", 5, "GOTOF AA"),
    "IF 1\nG1 X1": ("G605", 1, "IF without an end"),
    "ENDFOR": ("G605", 1, "ENDFOR without FOR"),
    "L77": ("G603", 1, "L77"),
    "DRESS(1)": ("G603", 1, "DRESS"),
    # what blocks mean
    "G1 X1 E3": ("G404", 7, "E"),
    "G1 X1 CR=5": ("G404", 7, "CR"),
    "G0 X1 I2": ("G404", 7, "I"),
    "G1 X1 AR=30": ("G404", 7, "AR"),
    "G2 X2 Y0 I1 J0 K1=3": ("G404", 16, "K1"),
    "CT X9 Y9 TURN=1": ("G404", 10, "TURN"),
    "CIP X6 Y8 I1=7 J1=7 TURN=1": ("G404", 21, "TURN"),
    "G3 X10 Y0 I5 J0 AR=90": ("G409", 1, "AR= with an end point and a centre"),
    "G3 X10 Y0 AR=90 K5": ("G410", 1, "a centre word across the plane"),
    "G1 X1 F100 FB=50": ("G403", 7, "F with FB"),
    "G1 G90 G91 X5": ("G403", 8, "G90 G91"),
    "G54 G0 G505 X5": ("G403", 8, "G54 G505"),
    "S100 M3 M5": ("G403", 9, "M3 M5"),
    "M8 M9": ("G403", 4, "M8 M9"),
    "CIP X6 Y8 I1 I1=7 J1=7": ("G404", 11, "I"),
    "G53 G0 Z40 A1": ("G404", 12, "A beside SUPA, G53 or G153"),
    "G53 G1 Z40 FB=50": ("G404", 12, "FB beside SUPA, G53 or G153"),
    "G4 F1 CR=2": ("G407", 7, "CR beside G4"),
    "G123": ("G401", 1, "G123"),
    "M77": ("G401", 1, "M77"),
    "G96 S100": ("G602", 1, "G96: constant cutting speed"),
    "G1 X1 RND=2": ("G602", 7, "RND=: roundings and chamfers between blocks"),
    "ORIPATH": ("G602", 1, "ORIPATH: ways of the tool axis but the shortest one"),
    "G331 Z-5 K1": ("G425", 1, "G331"),
    "CYCLE84(10,0,2,-9,,,3,,1,0,300,300)": ("G425", 1, "CYCLE84"),
    "MCALL CYCLE840(10,0,2,-9)": ("G425", 7, "CYCLE840"),
    "CYCLE86(10,0,2,-9,,0,3,1,1,1,0)": ("G602", 1, "CYCLE86: boring with an oriented spindle or by hand"),
    "G2 X10 Y0": ("G410", 1, "neither R nor the centre words of the plane"),
    "G2 X10 Y0 CR=4": ("G409", 1, "CR=4, and its ends are 10.0000 mm apart"),
    "N30 X10 G2 Y0 CR=4": ("G409", 9, "CR=4, and its ends are 10.0000 mm apart"),
    "N3 G2 X10 Y0": ("G410", 4, "neither R nor the centre words of the plane"),
    "CIP X10 Y0 I1=5 J1=0": ("G409", 1, "start, intermediate point and end of CIP are on a line"),
    "SCALE X2\nG2 X10 Y0 I5": ("G602", 1, "an arc under a SCALE that is not even in its plane"),
    "G1 X1 A3=1": ("G404", 7, "A3= without TRAORI"),
    "TRAORI\nG1 X1 A3=0 B3=0 C3=0": ("G415", 7, "A3=0 B3=0 C3=0"),
    "TRAORI\nG1 X1 A2=1 B2=2": ("G608", 7, "A2= B2= C2="),
    "TRAORI\nG1 X1 A30": ("G607", 7, "A30"),
    "TRAORI\nG1 X1 A30 A3=1": ("G607", 1, "two notations of the tool axis in one block"),
    "TRAORI(2)": ("G602", 1, "TRAORI(2): only the first transformation is read"),
    'TRANS X1\nCYCLE800(1,"",0,57,0,0,0,9,0,0,0,0,0,1)': (
        "G602",
        1,
        "CYCLE800 while TRANS, ROT, SCALE or MIRROR is in force",
    ),
    'CYCLE800(1,"",0,64,0,0,0,9,0,0,0,0,0,1)': ("G602", 1, "CYCLE800 by solid angles (_MODE=64)"),
    'CYCLE800(1,"",100200,57,0,0,0,9,0,0,0,0,0,1)': ("G602", 1, "CYCLE800 that aligns the tool (_ST=100200)"),
    "G0 SUPA Z0": ("G609", 4, "SUPA, G53 or G153"),
    "G1 X1\nG55 X2": ("G609", 1, "G55 after G54"),
    "X5 CYCLE81(10,0,2,-5)": ("G601", 4, "CYCLE81 beside other words"),
    "TRANS X1 G0": ("G601", 1, "TRANS beside other words"),
    "$P_UIFR[1]=CTRANS(X,5)": ("G602", 1, "$P_UIFR: variables of the system"),
    "TRAORI ORIMKS\nROT Z90\nG1 X1 A3=1": ("G607", 1, "vectors or angles after ORIMKS in a turned frame"),
    "T1 M6 D0\nG1 X1": ("G424", 1, "a cut after D0"),
    "G1 X12345678901": ("G406", 4, "X1.23457e+10"),
    "CYCLE81(1,0,2,-10)": ("G418", 1, "CYCLE81: RTP 1 is below RFP + SDIS"),
    "CYCLE81(10,0,2,5)": ("G418", 1, "CYCLE81: the depth 5 is not below RFP 0"),
    "HOLES1(0,0,0,0,1,3)": ("G418", 1, "HOLES1 without MCALL of a drilling cycle before it"),
    "T1\nG1 G41 X5\nTRANS X1": ("G419", 1, "TRANS"),
    "T1\nG1 G41 D1 X5\nX9 D2": ("G419", 4, "D2"),
    "G4 F2 X5": ("G407", 7, "X beside G4"),
    "M3": ("G405", 1, "M3 without S"),
    "M6": ("G405", 1, "M6 without T"),
    "D0\nG1 X1": ("G424", 1, "a cut after D0"),
    "SCALE X0": ("G606", 1, "a factor of 0"),
}


@pytest.mark.parametrize("text", FAULTS, ids=[text[:24] for text in FAULTS])
def test_faults(text):
    code, column, what = FAULTS[text]
    program, diagnostics = found(HEAD + text)
    assert program is None
    faulty = [each for each in diagnostics if each[0] == code]
    assert len(faulty) == 1, diagnostics
    lines = {"FOR": FIRST, "IF ": FIRST, "R1=": FIRST + 1}
    line = lines.get(text[:3], FIRST + text.count("\n"))
    assert faulty[0][1:] == (line, column, what)


def test_the_first_cut_needs_a_feed():
    text = "G90 G0 X0 Y0 Z1\nG1 X1\nX2"
    assert found(text)[1] == [("G408", 2, 1, "no F"), ("G408", 3, 1, "no F")]
    assert found(text, feed=5.0)[0].feed[1:].tolist() == [5, 5]


def test_a_rapid_move_of_rotary_axes_loses_the_place_of_the_tip():
    """It is known again when X, Y and Z are given with TRAORI."""
    text = HEAD + "G0 A30 C10\nTRAORI\nG0 X5 Y5\nG0 Z5\nG1 X1"
    program, diagnostics = found(text, axis_words="AC")
    assert not diagnostics
    assert program.position.tolist() == [[0, 0, 10], [5, 5, 5], [1, 5, 5]]
    assert found(HEAD + "G0 A30\nTRAORI\nG1 X5", axis_words="AC")[1][0][0] == "G416"
    assert found(HEAD + "G1 A30 X5", axis_words="AC")[1][0][0] == "G424"


def test_cycle800_warns_of_the_way_there():
    program, diagnostics = found(HEAD + 'CYCLE800(1,"",0,57,0,0,0,9,0,0,0,0,0,1)\nG0 X0 Y0 Z5')
    assert program is not None
    assert diagnostics == [("G610", 3, 1, "CYCLE800")]


def test_an_offset_without_a_move_needs_no_place():
    """Many programs end with G500."""
    assert not found(HEAD + "G1 X1\nG500")[1]
    assert not found("G500\n" + HEAD + "G1 X1")[1]


def test_a_drill_goes_along_the_tool():
    assert found(HEAD + "TRAORI\nG1 X1 A3=1 C3=1\nCYCLE81(10,0,2,-10)")[1][0][0] == "G429"


def test_a_long_dwell_is_a_warning():
    program, diagnostics = found(HEAD + "G4 F61\nG1 X1")
    assert program is not None
    assert diagnostics == [("G428", 3, 1, "61 s")]


def test_every_execution_ends():
    limits = ExecutionLimits(blocks=1000, depth=3)
    assert found(HEAD + "LOOP\nENDLOOP", limits)[1][0][0] == "G313"
    assert found("AA: G90 G0 X0 Y0 Z0\nGOTOB AA", limits)[1][0][0] == "G313"
    archive = "%_N_AA_MPF\nBB\nM30\n%_N_BB_SPF\nBB\nM17"
    assert found(archive, limits)[1][0][0] == "G314"


def test_loops_that_change_nothing_are_found_without_the_limit():
    again = "it jumps back again and again, and no variable that decides this has changed"
    assert found("AA: G90 G0 X0 Y0 Z0\nGOTOB AA")[1] == [("G313", 2, 1, again)]
    assert found(HEAD + "R1=1\nWHILE R1>0\nR1=3-R1\nENDWHILE")[1] == [("G313", 6, 1, again)]
    program, diagnostics = found(HEAD + "DEF INT AA[2]\nWHILE AA[1]<700\nAA[1]=AA[1]+1\nG1 X=AA[1]\nENDWHILE\nM30")
    assert diagnostics == []
    assert len(program) == 701


@pytest.mark.parametrize(
    "loop",
    [
        "R1=0\nAA: R1=R1+1\nG1 X=R1\nGOTOB AA\nM30",
        "DEF INT BB=0\nR2=1\nWHILE R2>0\nBB=BB+1\nR[3]=BB\nENDWHILE\nM30",
        "R1=0\nLOOP\nFOR R2=1 TO 3\nR1=R1+R2\nENDFOR\nENDLOOP\nM30",
    ],
)
def test_a_counter_that_decides_nothing_does_not_hide_a_loop_without_an_end(loop):
    """The limit of ten million blocks took minutes."""
    assert "no variable that decides this" in found(HEAD + loop, ExecutionLimits(blocks=100_000))[1][0][3]


@pytest.mark.parametrize(
    "loop",
    [
        "R1=0\nR3=1\nR2=0\nAA: G1 X=R1\nR1=R1+1\nR2=R1*R3\nIF R2<700 GOTOB AA\nM30",
        "R1=0\nR3=1\nR4=0\nAA: G1 X=R1\nR1=R1+1\nR[R3+3]=R1\nIF R4<700 GOTOB AA\nM30",
        "R1=0\nR3=1\nAA: G1 X=R1\nR1=R1+1\nIF R[R3]<700 GOTOB AA\nM30",
        "R1=0\nAA: G1 X=R1\nR1=R1+1\nM=30*(R1>=700)\nGOTOB AA\nM30",
        "R1=0\nDEF INT BB[3]\nLOOP\nG1 X=BB[2]\nBB[2]=BB[2]+1\nCASE BB[2] OF 700 GOTOF EE\nENDLOOP\nEE: M30",
        "R1=0\nAA: G1 X=R1\nR1=R1+1\nREPEAT BB CC P=(R1<700)\nIF R1<700 GOTOB AA\nM30\nBB: R2=1\nCC: R2=2\nM30",
    ],
)
def test_counters_that_end_a_loop_are_counted(loop):
    program, diagnostics = found(HEAD + loop)
    assert (program is None, diagnostics) == (False, [])
    assert program.position[:, 0].max() == 699


def test_the_counter_of_a_subprogram_ends_its_loop():
    archive = (
        f"%_N_AA_MPF\n{HEAD}BB(700)\nM30\n"
        "%_N_BB_SPF\nPROC BB(INT MOST)\nDEF INT NOW=0,NEXT\nCC: G1 X=NOW\nNEXT=NOW+1\nNOW=NEXT\nIF NOW<MOST GOTOB CC"
        "\nM17"
    )
    program, diagnostics = found(archive)
    assert diagnostics == [] and program.position[:, 0].max() == 699


def test_a_program_needs_an_end():
    assert found(HEAD + "G1 X1", needs_end=True)[1] == [("G430", 3, 1, "no M2, M30, M17 or RET after it")]
    for end in ("M2", "M30", "M17", "RET", "N10 G0 X1 M30"):
        assert found(HEAD + "G1 X1\n" + end, needs_end=True)[0] is not None


def test_moves_without_a_place_name_the_coordinate_that_was_never_given():
    assert found("G90 G54\nG0 X1 Y2\nG1 X3 F100\nM30")[1] == [("G436", 2, 1, "Z was never given")]
    assert found("G90 G54\nS100 M3\nM30")[1] == [("G420", 0, 0, "3 lines")]


def test_faults_behind_the_first_are_reported_and_consequences_are_not():
    _, diagnostics = found("G90 G54\nG1 X1 Y2 Z3 F?\nX5\nRND=3\nM77 X4\nM30")
    assert [each[:2] for each in diagnostics] == [("G101", 2), ("G602", 4), ("G401", 5)]
    # Without line 4 the arc in force goes on, and begins elsewhere.
    _, diagnostics = found(HEAD + "G3 X10 Y0 CR=8\nG1 X50 RND=2\nY20\nG2 X60 I5 J0\nM30")
    assert [each[:2] for each in diagnostics] == [("G602", 4)]
    _, diagnostics = found(HEAD + "T1\nG1 G41 X5\nX9\nG40 X20 RND=2\nTRANS X1\nCYCLE81(10,0,2,-5)\nM30")
    assert [each[:2] for each in diagnostics] == [("G602", 6)]


def test_codes_are_left_out_as_chosen():
    program, diagnostics = found(HEAD + "M77 G1 X1", left_out=("M77",))
    assert not diagnostics
    assert "M77, left out as chosen (line 3)" in program.reading


def test_work_offsets_have_their_places():
    offsets = {"G54": (0.0, 0.0, 0.0, 0.0), "G505": (100.0, 0.0, 0.0, 90.0)}
    program, diagnostics = found(HEAD + "G1 X1 Y2\nG505 X1 Y2", work_offsets=offsets)
    assert not diagnostics
    assert program.position[1:].round(12).tolist() == [[1, 2, 10], [98, 1, 10]]
    assert found(HEAD + "G55 X1", work_offsets=offsets)[1][0][::3] == ("G609", "G55")
    assert not found(HEAD + "G1 X1\nG500", work_offsets=offsets)[1]
    assert found(HEAD + "G500\nG1 X1", work_offsets=offsets)[1][0][::3] == ("G609", "G500")
    assert not found(HEAD + "G500\nG54 G1 X1", work_offsets=offsets)[1]


def test_an_arc_by_its_angle_leaves_other_arcs_beside_it_alone():
    program, diagnostics = found(HEAD + "G3 I5 J0 AR=180\nG3 X20 I5 J0\nG2 X10 CR=5")
    assert not diagnostics
    assert program.position[1:].round(9).tolist() == [[10, 0, 10], [20, 0, 10], [10, 0, 10]]


def test_subprograms_in_other_files(tmp_path):
    (tmp_path / "l10.SPF").write_text("G91 G1 X1\nG90\nM17\n")
    (tmp_path / "STEP.SPF").write_text("%_N_STEP_SPF\nPROC STEP(REAL HIGH)\nG1 Z=HIGH\nRET\n")
    text = HEAD + "L10 P2\nSTEP(3)\nM30"
    program, diagnostics = found(text, folders=(tmp_path,))
    assert not diagnostics
    assert program.position.tolist() == [[0, 0, 10], [1, 0, 10], [2, 0, 10], [2, 0, 3]]
    assert program.line.tolist() == [2, 1, 1, 3]
    assert program.operations == ("", "subprogram l10.SPF", "subprogram STEP.SPF")
    assert found(text)[1][0] == ("G603", 3, 1, "L10")
    (tmp_path / "STEP.SPF").write_text("PROC STEP(REAL HIGH)\nG1 Z=?\nRET\n")
    program, diagnostics = read(text, "part.mpf", ReadOptions(default_tool=TOOL, folders=(tmp_path,)))
    assert (diagnostics[0].place.file, diagnostics[0].place.line) == (str(tmp_path / "STEP.SPF"), 2)


@pytest.mark.parametrize(
    "text", ["", ";", "\n\n", "%_N_A_MPF\n", "\x00\xff", '"' * 99, "G" * 20000, "N" * 500, "=" * 50]
)
def test_any_text_is_read_or_refused(text):
    program, diagnostics = read(text, "part.mpf", ReadOptions(default_tool=TOOL))
    assert program is None
    assert any(each.severity is Severity.ERROR for each in diagnostics)


def test_rotary_words_of_zero_beside_supa_leave_an_upright_tool():
    program, diagnostics = found(f"{HEAD}SUPA G0 Z40 A0 C0\nM30\n", machine_zero=(0, 0, 0), axis_words="AC")
    assert program is not None and not diagnostics
    text = f"{HEAD}TRAORI\nG1 X1 A30 C0\nSUPA G0 Z40 A0 C0\nM30\n"
    program, diagnostics = found(text, machine_zero=(0, 0, 0), axis_words="AC")
    assert program is None and [each[:2] for each in diagnostics] == [("G404", 5)]
