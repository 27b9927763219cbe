# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the points under CUTCOM are, by the command line: what is posted, and what is said of it."""

import json

import pytest

import pkm_post
from pkm_post.cli import main
from pkm_post.reading.part_program import ReadingOptions

RECTANGLE = """\
TOOL PATH/PROFILE,TOOL,MILL_10
UNITS/MM
TLDATA/MILL,10.0,0.0,75.0,0.0,0.0
MSYS/0,0,0,1,0,0,0,1,0
{header}
LOAD/TOOL,1
RAPID
GOTO/-45,-20,20,0,0,1
FEDRAT/MMPM,500
GOTO/-45,-20,0
CUTCOM/LEFT
GOTO/-25,-20,0
GOTO/-25,25,0
GOTO/25,25,0
GOTO/25,-25,0
GOTO/-20,-25,0
CUTCOM/OFF
GOTO/-20,-45,0
END-OF-PATH
"""
CENTRE, CONTOUR, NEITHER = "$$ centerline data", "$$ contact contour data", "PAINT/PATH"


def corner(capsys, folder, header, *arguments):
    """Post a rectangle; its upper right corner, and what the report says of the reading."""
    file = folder / "part.cls"
    file.write_text(RECTANGLE.format(header=header))
    code = main(["post", str(file), "--out", str(folder), "--tool-length", "1=100", *arguments])
    printed = capsys.readouterr()
    if code:
        return code, printed.err
    program = json.loads((folder / "part-report.json").read_text())["program"]
    assert set(program["reading"]) <= set((printed.out + printed.err).splitlines())
    return program["box_mm"][1][:2], program["reading"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "header, arguments, place, words",
    [
        (CENTRE, [], 25.0, "points are the centre of the tool, as $$ centerline data says"),
        (CONTOUR, [], 30.0, "points are the contour of the part, as $$ contact contour data says"),
        (NEITHER, ["--contour-data", "centre"], 25.0, "points are the centre of the tool, as the option says"),
        (NEITHER, ["--contour-data=contour"], 30.0, "points are the contour of the part, as the option says"),
        (CENTRE, ["--contour-data=contour"], 30.0, "points are the contour of the part, as the option says"),
        (CENTRE, ["--wear=1=-0.2"], 24.8, "points are the centre of the tool, as $$ centerline data says"),
        (CONTOUR, ["--wear=1=0.2"], 30.2, "points are the contour of the part, as $$ contact contour data says"),
        (CONTOUR, ["--tool=1=8"], 29.0, "points are the contour of the part, as $$ contact contour data says"),
    ],
)
def test_what_is_posted_is_where_the_reading_has_it(capsys, tmp_path, header, arguments, place, words):
    box, reading = corner(capsys, tmp_path, header, *arguments)
    assert box == [place, place]
    assert reading == [f"CUTCOM in line 11: {words}"]


@pytest.mark.parametrize("points", ["centre", "contour"])
def test_a_macro_and_the_command_line_write_the_same_bytes(capsys, tmp_path, points):
    corner(capsys, tmp_path, NEITHER, f"--contour-data={points}", "--wear=1=-0.05", "--unit=mm")
    reading = ReadingOptions(unit="mm", contour_data=points, wear={1: -0.05})
    pkm_post.post(tmp_path / "part.cls", out=tmp_path / "macro", tool_lengths={1: 100.0}, reading=reading)
    for name in ("part.pmc", "part.pkmt", "part-report.json"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "macro" / name).read_bytes()


def test_two_readings_are_refused_and_nothing_is_written(capsys, tmp_path):
    code, reported = corner(capsys, tmp_path, NEITHER)
    assert code == 1
    assert "line 11:1: error L429" in reported and "--contour-data contour or --contour-data centre" in reported
    assert [path.name for path in tmp_path.iterdir()] == ["part.cls"]


@pytest.mark.parametrize("command", ["check", "reach", "convert"])
@pytest.mark.parametrize("choice", [[], ["--contour-data=centre"], ["--contour-data=contour"]])
def test_all_commands_take_the_option(capsys, tmp_path, command, choice):
    file = tmp_path / "part.cls"
    file.write_text(RECTANGLE.format(header=NEITHER))
    more = {
        "check": [],
        "reach": ["--tool-length=1=100"],
        "convert": ["--to=gcode:3axis", f"--out={tmp_path / 'out.nc'}"],
    }
    code = main([command, str(file), *more[command], *choice])
    reported = capsys.readouterr()
    assert code == (0 if choice else 1)
    assert ("L429" in reported.err + reported.out) == (not choice)
    if command == "convert" and choice:
        assert ("G41" in (tmp_path / "out.nc").read_text()) == (choice == ["--contour-data=contour"])


def test_check_says_how_the_points_were_taken(capsys, tmp_path):
    file = tmp_path / "part.cls"
    file.write_text(RECTANGLE.format(header=CENTRE))
    said = "CUTCOM in line 11: points are the centre of the tool, as $$ centerline data says"
    assert main(["check", str(file)]) == 0
    assert f"{file}: {said}" in capsys.readouterr().out
    assert main(["check", "--json", str(file)]) == 0
    assert json.loads(capsys.readouterr().out)[0]["reading"] == [said]


def test_wear_of_g_code_is_reported(capsys, tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text("G21 G0 X0 Y0 Z5\nG1 X5 F100\nM2\n")
    assert main(["check", str(file), "--wear=1=0.1"]) == 1
    assert "L432" in capsys.readouterr().out
