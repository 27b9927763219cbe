# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code and CL data are posted without FreeCAD, or refused with all that is wrong."""

import hashlib
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from interpreter import PYTHON

from pkm_post.cli import main
from pkm_post.model import Phrase, Refused, Tool
from pkm_post.model.certificate import Tolerances
from pkm_post.options.choices import Options
from pkm_post.posting.post_file import post_file
from pkm_post.reading.part_program import ReadingOptions
from pkm_post.toolpath import StartLine
from pkm_post.writing import trajectory_file

ADDON = Path(__file__).parents[2]
WORK_OFFSET = np.eye(4)
WORK_OFFSET[2, 3] = 250.0

G_CODE = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G43.5 I0 J0 K1
G1 X10 Y0 Z20 I0.1 J0 K1 F600
G1 X20 Y5 Z20 I0.1 J0.1 K1
G0 Z30
M5
M30
"""
CL_DATA = """\
PARTNO TEST
UNITS/MM
MULTAX/ON
CUTTER/10.0
LOADTL/1
SPINDL/RPM,8000,CLW
RAPID
GOTO/0,0,30,0,0,1
FEDRAT/600,MMPM
GOTO/10,0,20,0.099503719020999,0,0.995037190209989
GOTO/20,5,20,0.099014754297667,0.099014754297667,0.990147542976674
RAPID
GOTO/20,5,30
SPINDL/OFF
FINI
"""
SIEMENS = """\
%_N_PART_MPF
DEF REAL STEP=10
T="1" D1
M6
G71 G90 G94 G17 G54 S8000 M3
CYCLE832(0.01,1,1)
TRAORI
ORIWKS ORIVECT
CYCLE832()
G0 X0 Y0 Z30 A3=0 B3=0 C3=1
FOR R1=1 TO 2
STEPS(R1, STEP)
ENDFOR
G0 Z30
TRAFOOF
M5
M30
%_N_STEPS_SPF
PROC STEPS(INT NUMBER, REAL WIDTH)
IF NUMBER==1
G1 X=IC(WIDTH) Y0 Z20 A3=0.1 B3=0 C3=1 F600
ELSE
G1 X=WIDTH*NUMBER Y5 Z20 A3=0.1 B3=0.1 C3=1
ENDIF
M17
"""


def cutter(diameter):
    return Tool(1, "", diameter, 0.0, 0.0, corner_known=False)


def posted(folder, name, text, **choices):
    file = folder / name
    file.write_text(text)
    choices = {"tool_lengths": {1: 60.0}, "options": Options(work_offset=WORK_OFFSET)} | choices
    return post_file(file, choices.pop("machine", "example_6tps"), folder / "out", **choices)


@pytest.mark.slow
def test_g_code_siemens_s_language_and_cl_data_of_one_path_give_one_report(tmp_path):
    reports = [
        posted(tmp_path, "a.mpf", SIEMENS, reading=ReadingOptions("none", {1: cutter(10.0)})).report,
        posted(tmp_path, "a.ngc", G_CODE, reading=ReadingOptions("vector", {1: cutter(10.0)})).report,
        posted(tmp_path, "a.cls", CL_DATA).report,
    ]
    assert all(report["certificate"]["holds"] for report in reports)
    assert reports[0]["motion"] == reports[1]["motion"] == reports[2]["motion"]


G_HOLES = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G98 G81 X10 Y0 R3 Z-9 F300
G81 X-15 Y5 R13 Z1
G80
M5
M30
"""
SIEMENS_HOLES = """\
T1 D1
M6
G71 G90 G94 G17 S8000 M3
G0 X0 Y0 Z30
F300
MCALL CYCLE81(30,0,3,-9)
G0 X10 Y0
MCALL CYCLE81(30,10,3,,9)
X-15 Y5
MCALL
M5
M30
"""
CL_HOLES = """\
TOOL PATH/HOLES,TOOL,D
UNITS/MM
TLDATA/DRILL,10.0,0.0,75.0,118.0,35.0
LOAD/TOOL,1
SPINDL/RPM,8000,CLW
RAPID
GOTO/0,0,30,0,0,1
CYCLE/DRILL,RAPTO,3.0,FEDTO,-9.0,RTRCTO,AUTO,MMPM,300.0
GOTO/10,0,0
GOTO/-15,5,10
CYCLE/OFF
SPINDL/OFF
END-OF-PATH
"""


@pytest.fixture
def fine_machine(tmp_path):
    """The example machine with a decimal more, which the full acceleration of long rapid moves needs (V118)."""
    text = (ADDON / "resources" / "machines" / "example_6tps.toml").read_text(encoding="utf-8")
    file = tmp_path / "fine.toml"
    file.write_text(text.replace("length_decimals = 6", "length_decimals = 7"), encoding="utf-8")
    return str(file)


@pytest.mark.slow
def test_canned_cycles_and_cycles_of_cl_data_give_one_report(tmp_path, fine_machine):
    reading = ReadingOptions("vector", {1: cutter(10.0)})
    canned = posted(tmp_path, "a.ngc", G_HOLES, reading=reading, machine=fine_machine).report
    cycles = posted(tmp_path, "a.cls", CL_HOLES, machine=fine_machine).report
    called = posted(tmp_path, "a.mpf", SIEMENS_HOLES, reading=reading, machine=fine_machine).report
    assert called["motion"] == canned["motion"]
    assert canned["certificate"]["holds"]
    assert canned["motion"] == cycles["motion"]
    assert cycles["program"]["reading"] == ["CYCLE in line 8: words of NX, by the dialect"]


def test_numbers_without_words_are_posted_when_they_are_named(tmp_path, fine_machine, capsys):
    file = tmp_path / "part.aptsource"
    words = "CYCLE/DRILL,9.,300.,3.,MMPM"
    holes = CL_HOLES.replace("TLDATA/DRILL,10.0,0.0,75.0,118.0,35.0\n", "").replace("TOOL PATH/HOLES,TOOL,D\n", "")
    lines = [words if line.startswith("CYCLE/DRILL") else line for line in holes.splitlines()]
    file.write_text("\n".join(["$$ CATIA APT VERSION 1.0", *lines, ""]))
    command = ["post", str(file), "--machine", fine_machine, "--out", str(tmp_path / "out")]
    command += ["--work-offset=0,0,250", "--tool-length=1=60"]
    assert main(command) == 1
    assert "L420" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    assert main([*command, "--cycle-values=depth,feed,clearance"]) == 0
    assert "numbers are depth, feed, clearance, as the option says" in capsys.readouterr().out


CONTOUR = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X-30 Y-30 Z20
G1 G41 X-20 Y-20 F600
Y20
X20
Y-20
X-20
G1 G40 X-30 Y-30
M30
"""


CIRCLES = """\
%
G21 G90 G17 G94 G40
T1 M6
G0 X-20 Y0 Z20
G1 Z10 F600
G2 X-20 Y0 I20 J0 Z4
G3 X0 Y-20 I20 J0
G1 Z20
M30
%
"""


def test_the_box_of_a_program_has_its_arcs(tmp_path):
    made = posted(tmp_path, "circles.ngc", CIRCLES, reading=ReadingOptions("none", {1: cutter(8.0)}))
    box = np.array(made.report["program"]["box_mm"])
    np.testing.assert_allclose(box[:, :2], [[-20, -20], [20, 20]], atol=2e-3)


def test_a_compensated_contour_is_cut_beside_what_is_programmed(tmp_path):
    made = posted(tmp_path, "contour.ngc", CONTOUR, reading=ReadingOptions("none", {1: cutter(8.0)}))
    assert made.report["certificate"]["holds"]
    (x0, y0, _), (x1, y1, _) = made.report["program"]["box_mm"]
    assert (x1, y1) == (24.0, 24.0)
    assert (x0, y0) == (-30.0, -30.0)


def test_a_contour_too_narrow_for_the_tool_is_refused(tmp_path):
    with pytest.raises(Refused) as refused:
        posted(tmp_path, "a.ngc", CONTOUR.replace("G41", "G42"), reading=ReadingOptions("none", {1: cutter(60.0)}))
    assert {fault.code for fault in refused.value.diagnostics} <= {"N202", "N204", "N205"}


def test_the_trajectory_names_its_source_by_its_hash(tmp_path):
    made = posted(tmp_path, "part.ngc", G_CODE, reading=ReadingOptions("vector"))
    trajectory, _ = trajectory_file.read(made.program.with_suffix(".pkmt"))
    assert trajectory.source_fingerprint == hashlib.sha256(G_CODE.encode()).hexdigest()
    assert trajectory.tolerances == Tolerances(0.001, np.radians(0.001))


def test_all_files_carry_the_stem(tmp_path):
    made = posted(tmp_path, "part.ngc", G_CODE, reading=ReadingOptions("vector")).files
    assert sorted(path.name for path in made) == [
        "part-manifest.json",
        "part-report.html",
        "part-report.json",
        "part-setup.pmc",
        "part.pkmt",
        "part.pmc",
    ]


@pytest.mark.parametrize(
    ("name", "text", "choices", "codes"),
    [
        ("a.ngc", G_CODE, {"tool_lengths": {}, "reading": ReadingOptions("vector")}, ["J113"]),
        ("a.cls", CL_DATA, {"tool_lengths": {}}, ["J113"]),
        ("a.cls", CL_DATA.replace("LOADTL/1", "LOADTL/1,LENGTH,10000.5"), {"tool_lengths": {}}, ["J113"]),
        ("a.cls", "GOTO/1,2\nFINI\n", {}, ["L402"]),
        ("a.ngc", G_CODE, {"reading": ReadingOptions("vector"), "options": Options(work_offset="G59")}, ["K108"]),
    ],
)
def test_what_is_wrong_is_reported_and_nothing_is_written(tmp_path, name, text, choices, codes):
    with pytest.raises(Refused) as refused:
        posted(tmp_path, name, text, **choices)
    assert [fault.code for fault in refused.value.diagnostics] == codes
    assert not list((tmp_path / "out").glob("*"))


def test_faults_of_machine_and_file_are_reported_together(tmp_path):
    (tmp_path / "a.cls").write_text("GOTO/1,2\nFINI\n")
    with pytest.raises(Refused) as refused:
        post_file(tmp_path / "a.cls", "no_such_machine", tmp_path)
    assert [fault.code for fault in refused.value.diagnostics] == ["M101", "L402"]


@pytest.mark.parametrize("names", [("part.ngc", "part.cls"), ("part.ncl.1", "part.ncl.2")])
def test_files_of_one_name_do_not_overwrite_each_others_results(tmp_path, capsys, names):
    files = [str(tmp_path / name) for name in names]
    for file in files:
        Path(file).write_text(CL_DATA)
    assert main(["post", *files, "--out", str(tmp_path / "out")]) == 2
    errors = capsys.readouterr().err
    assert "would both be posted as part.pmc; " in errors and "or post to different folders" in errors
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_no_result_replaces_the_tool_table(tmp_path, capsys):
    """The table is an input as the program is: F120, whichever command writes, and its bytes remain."""
    (tmp_path / "part.ngc").write_text("G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z30\nG1 X5 F600\nM5\nM30\n")
    table = tmp_path / "part.csv"
    table.write_text("number,diameter,length\n1,10,120\n")
    common = [str(tmp_path / "part.ngc"), "--tool-table", f"{table},mm", "--out"]
    assert main(["post", *common, str(tmp_path), "--also", "csv", "--work-offset=0,0,250"]) == 1
    assert "F120" in capsys.readouterr().err
    assert main(["convert", *common, str(table), "--to", "gcode:3axis"]) == 1
    assert "F120" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["part.csv", "part.ngc"]
    assert table.read_text().startswith("number,")
    assert main(["post", *common, str(tmp_path), "--work-offset=0,0,250"]) == 0


def test_the_command_line_needs_no_freecad_for_part_programs(tmp_path):
    (tmp_path / "a.ncl.7").write_text(CL_DATA)
    arguments = ["post", "a.ncl.7", "--out", "made", "--work-offset=0,0,250", "--tool-length", "1=60"]
    script = "import sys; sys.modules['FreeCAD'] = None; from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))"
    reported = subprocess.run(
        [PYTHON, "-c", script, *arguments],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ADDON), "PATH": "/usr/bin:/bin", "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert reported.returncode == 0, reported.stderr
    assert (tmp_path / "made" / "a.pmc").exists()


# Gauge lengths

OF_ANOTHER_NUMBER = G_CODE.replace("G43 H1\n", "G43 H11\n").replace("G43.5 I0 J0 K1\n", "").replace("I0.1 J0 K1 ", "")
OF_ANOTHER_NUMBER = OF_ANOTHER_NUMBER.replace(" I0.1 J0.1 K1", "")
WITH_A_LENGTH = CL_DATA.replace("LOADTL/1", "LOADTL/1,LENGTH,60")


def refusal_of(*arguments, **choices):
    with pytest.raises(Refused) as refused:
        posted(*arguments, **choices)
    return [fault.code for fault in refused.value.diagnostics]


@pytest.mark.parametrize(
    ("name", "text"), [("a.ngc", G_CODE), ("a.cls", CL_DATA), ("a.cls", WITH_A_LENGTH)], ids=["G-code", "CL", "LENGTH"]
)
def test_a_length_for_a_tool_that_is_not_there_is_refused(tmp_path, name, text):
    with pytest.raises(Refused) as refused:
        posted(tmp_path, name, text, tool_lengths={1: 60.0, 11: 75.0}, reading=ReadingOptions("vector"))
    fault = refused.value.diagnostics[-1]
    assert fault.code == "J126" and isinstance(fault.found, Phrase)
    assert not list((tmp_path / "out").glob("*"))


@pytest.mark.slow
def test_the_length_of_the_file_is_replaced_and_that_is_reported(tmp_path):
    own = posted(tmp_path, "a.cls", WITH_A_LENGTH, tool_lengths={})
    assert own.diagnostics == ()
    same = posted(tmp_path, "a.cls", WITH_A_LENGTH, tool_lengths={1: 60.0})
    assert same.diagnostics == ()
    other = posted(tmp_path, "a.cls", WITH_A_LENGTH, tool_lengths={1: 75.0})
    (reported,) = other.diagnostics
    assert (reported.code, reported.found) == ("J125", "--tool-length 1=75 instead of 60 of T1")
    assert trajectory_file.read(other.program.with_suffix(".pkmt"))[0].tools[1].length == 75.0


def tips(made):
    return trajectory_file.read(made.program.with_suffix(".pkmt"))[0].tip


@pytest.mark.slow
def test_an_offset_of_another_number_lifts_the_tip_by_what_it_is_longer(tmp_path):
    # rs274 of LinuxCNC 2.9 with T1 Z60 and T11 Z75 in its tool table: T1 M6 G43 H11 prints USE_TOOL_LENGTH_OFFSET 75
    # and with H1 60: H alone counts, whatever is in the spindle, so the spindle and the tip of T1 are 15 mm higher.
    own = posted(tmp_path, "a.ngc", OF_ANOTHER_NUMBER.replace("H11", "H1"))
    other = posted(tmp_path, "b.ngc", OF_ANOTHER_NUMBER, tool_lengths={1: 60.0, 11: 75.0})
    np.testing.assert_allclose(tips(other) - tips(own), np.tile([0, 0, 15.0], (len(tips(own)), 1)), atol=1e-12)
    equal = posted(tmp_path, "c.ngc", OF_ANOTHER_NUMBER, tool_lengths={1: 60.0, 11: 60.0})
    np.testing.assert_allclose(tips(equal), tips(own), atol=1e-12)


def test_an_offset_whose_value_is_not_known_is_refused(tmp_path):
    assert refusal_of(tmp_path, "a.ngc", OF_ANOTHER_NUMBER) == ["J128"]
    assert refusal_of(tmp_path, "a.ngc", OF_ANOTHER_NUMBER, tool_lengths={11: 75.0}) == ["J113"]


def test_the_next_tool_keeps_the_offset_that_is_in_force(tmp_path):
    """T2 is 10 mm shorter than T1, whose H1 is in force still: its tip is 10 mm higher, until its own G43."""
    text = "T1 M6 G43 H1\nG21 G90 G94 S8000 M3\nG0 X0 Y0 Z30\nT2 M6\nG0 X10 Z30\nG43 H2\nG0 X20 Z30\nM30\n"
    made = posted(tmp_path, "a.ngc", text, tool_lengths={1: 60.0, 2: 50.0})
    at = {round(float(x)): float(z) - 250.0 for x, _, z in tips(made)}
    assert (at[0], at[10], at[20]) == (30.0, 40.0, 30.0)


def test_arguments_are_typed_as_on_the_command_line(tmp_path, capsys):
    (tmp_path / "a.ngc").write_text(G_CODE)
    typed = "--tool-length 1=60 --work-offset=0,0,250 --tip-tolerance 0.003 --spin x-in-plane=10 --also csv"
    made = post_file(tmp_path / "a.ngc", out=tmp_path / "macro", arguments=typed, reading=ReadingOptions("vector"))
    line = ["post", str(tmp_path / "a.ngc"), "--axis-words", "vector", "--out", str(tmp_path / "line"), *typed.split()]
    assert main(line) == 0
    assert [path.name for path in made.files] == sorted(path.name for path in (tmp_path / "line").iterdir())
    for path in made.files:
        assert path.read_bytes() == (tmp_path / "line" / path.name).read_bytes()
    with pytest.raises(Refused, match="J117"):
        post_file(tmp_path / "a.ngc", out=tmp_path, arguments="--no-such-thing")
    with pytest.raises(ValueError, match="got both"):
        post_file(tmp_path / "a.ngc", out=tmp_path, arguments=typed, options=Options())


BY_HAND = """\
T1 M6 G43 H1
G21 G90 G94
G0 X{} Y0 Z{}
G43.5 I0.1 J0 K1
S8000 M3
G1 X10 Y0 Z20 I0.1 J0 K1 F600
G1 X20 Y5 Z20 I0.1 J0.1 K1
G0 Z30
M5
M30
"""
"""The program below from its second cut on: down along the tool axis from above everything."""


@pytest.mark.slow
def test_a_program_from_a_line_is_what_one_would_write_by_hand(tmp_path):
    rise = (30.0 - 20.0) / 1.0
    texts = {"whole": G_CODE, "hand": BY_HAND.format(10 + 0.1 * rise, 30)}
    options, reading = Options(work_offset=WORK_OFFSET), ReadingOptions("vector")
    made = {}
    for name, text in texts.items():
        (tmp_path / f"{name}.ngc").write_text(text)
        chosen = replace(options, from_line=StartLine(6)) if name == "whole" else options
        file, out = tmp_path / f"{name}.ngc", tmp_path / "out"
        report = post_file(file, out=out, options=chosen, tool_lengths={1: 120.0}, reading=reading).report
        assert report["certificate"]["holds"]
        made[name], faults = trajectory_file.read(tmp_path / "out" / f"{name}.pkmt")
        assert not faults
    begun, hand = made["whole"], made["hand"]
    for name in ("tip", "axis", "feed", "kind"):
        np.testing.assert_allclose(getattr(begun, name)[-3:], getattr(hand, name)[-3:], atol=1e-9, err_msg=name)
    np.testing.assert_allclose(begun.tip[-4], hand.tip[-4], atol=1e-9)
    spindle = [(len(one) - each.row, each.value) for one in (begun, hand) for each in one.events if each.value == 8000]
    assert spindle == [(3, 8000.0), (3, 8000.0)]


def test_a_line_that_is_not_there_is_refused(tmp_path):
    options = Options(work_offset=WORK_OFFSET, from_line=StartLine(40))
    with pytest.raises(Refused) as refused:
        posted(tmp_path, "part.ngc", G_CODE, options=options, reading=ReadingOptions("vector"))
    (found,) = [each.found for each in refused.value.diagnostics if each.code == "K150"]
    last = max(number for number, block in enumerate(G_CODE.splitlines(), 1) if "X" in block or "Z" in block)
    assert found == f"the last line that moves is {last}" and isinstance(found, Phrase)
    assert not list((tmp_path / "out").glob("*"))
