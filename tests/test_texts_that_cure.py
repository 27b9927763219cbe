# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of faults say what is wrong and what mends it, in words that the user finds again."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from pkm_post.cli import main
from pkm_post.machine import poses_along, strut_lengths
from pkm_post.model import RULES, errors
from pkm_post.posting import prepared_file, study
from pkm_post.reading import ReadingOptions, read_part_program

ROOT = Path(__file__).parents[1]
HEAD = "G21 G90 G94\nT1 M6\nS8000 M3\n"
PLACED = "--tool-length 1=120 --work-offset=0,0,250"


def checked(tmp_path, blocks, **changes):
    """The program on the example machine, changed if need be, with all its checks; the findings; the machine."""
    part = tmp_path / "part.ngc"
    part.write_text(f"{HEAD}{blocks}\nM30\n")
    program = prepared_file(part, arguments=PLACED)
    machine = replace(program.sound[1], **changes)
    result, findings = study(program.sound[0], machine, program.options)
    return result, findings, machine


@pytest.mark.parametrize(("blocks", "missing"), [("G0 X0 Y0\nG1 X40 F600", "Z was"), ("G1 X40 F600", "Y and Z were")])
@pytest.mark.parametrize("flavour", ["rs274", "fanuc"])
def test_a_coordinate_that_was_never_given_is_named(tmp_path, capsys, blocks, missing, flavour):
    part = tmp_path / "part.ngc"
    part.write_text(f"{HEAD}{blocks}\nM30\n")
    assert main(["check", "--flavour", flavour, str(part)]) == 1
    said = capsys.readouterr()
    assert f"G436: no move has a known position: {missing} never given; give X, Y and Z" in said.out + said.err
    assert "G420" not in said.out + said.err  # there are motions


@pytest.mark.parametrize(
    ("code", "flavour", "blocks", "cured"),
    [
        ("G439", "rs274", "G80 X1", "G80 G0 X1"),
        ("G439", "rs274", "G2 X2 I1\nG53 X1", "G2 X2 I1\nG53 G1 X1"),
        ("G439", "siemens", "G2 X2 I1 J0\nSUPA X1", "G2 X2 I1 J0\nSUPA G1 X1"),
        ("G440", "fanuc", "G91 G53 X1.", "G90 G53 X1."),
        ("G440", "fanuc", "G16 G91\nX5. Y30.", "G16 G90\nX5. Y30."),
        ("G441", "rs274", "G93 G81 X1 Z-1 R2 F2", "G94 F90 G81 X1 Z-1 R2"),
        ("G441", "siemens", "G93 F2\nCYCLE81(5,0,1,-3)", "G94 F90\nCYCLE81(5,0,1,-3)"),
        ("G407", "rs274", "G0 G92 X1 Z5", "G92 X1\nG0 Z5"),
        ("G407", "rs274", "G0 @1 X1", "G0 @1 ^30"),
        ("G407", "siemens", "G4 F2 X5", "G4 F2\nX5"),
    ],
)
def test_the_cure_of_axis_words_mends_them(tmp_path, code, flavour, blocks, cured):
    codes = []
    for text in (blocks, cured):
        part = tmp_path / "part.ngc"
        part.write_text(f"G21 G90\nS900 M3\nG0 X0 Y0 Z5\nF100\n{text}\nM30\n")
        reading = ReadingOptions(flavour=flavour, machine_zero=(0.0, 0.0, 0.0), allow_open_end=True)
        codes.append({each.code for each in errors(read_part_program(part, reading)[1])})
    assert codes == [{code}, set()]


@pytest.mark.parametrize(("move", "expected"), [("G0", {"K128": 4}), ("G1 F1200", {"K128": 4, "K118": 5})])
def test_only_of_a_cutting_move_is_a_lower_feed_the_cure(tmp_path, move, expected):
    # line 4 is the rapid way from home, line 5 the move
    _, findings, _ = checked(tmp_path, f"G0 X0 Y0 Z0\n{move} X150 Y100 Z-40", strut_speed=5.0)
    assert {each.code: each.place.line for each in findings} == expected
    assert "lower feed" in RULES["K118"].cure and "feed" not in RULES["K128"].cure


def test_the_cure_of_a_tool_that_cannot_be_lifted_names_properties_of_the_operation():
    rows = re.findall(r"^\| ([A-Z][A-Za-z, ]+) \|", (ROOT / "docs/surface-finish.md").read_text(encoding="utf-8"), re.M)
    properties = {name for row in rows for name in row.split(", ")}
    named = set(re.findall(r"\b(?:ConeLimit|Lead|Tilt)\b", RULES["N304"].cure))
    assert named == {"ConeLimit", "Lead", "Tilt"} <= properties
    panel = (ROOT / "pkm_post/freecad_gui/surface_finish_panel.py").read_text(encoding="utf-8")
    assert (
        "field Cone limit" in RULES["N304"].cure
        and '"ConeLimit", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Cone limit")' in panel
    )


def test_strut_lengths_are_reported_by_what_is_left_of_them(tmp_path):
    """A margin within limits is positive, and is the length beyond the shortest one: nothing is "-257.9, limit 0"."""
    result, findings, machine = checked(tmp_path, "G0 X0 Y0 Z0\nG1 X10 Y5 Z-20 F600\n")
    (row,) = [line for line in result.text().splitlines() if line.startswith("shortest struts")]
    length = strut_lengths(machine, *poses_along(result.reach.trajectory))
    left = float((length - machine.strut_stroke[0]).min())
    assert left > 0.0 and f" {left:.4g} mm " in row and "-" not in row.replace(row.split()[-1], "")
    assert {each.code for each in findings} <= {"K128", "V131"}
