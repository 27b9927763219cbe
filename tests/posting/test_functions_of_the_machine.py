# SPDX-License-Identifier: LGPL-2.1-or-later
"""M codes that the machine file names go to the controller, and no others do."""

import pytest

from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import machine_of
from pkm_post.model import Event, EventKind, Refused
from pkm_post.posting import post_file
from pkm_post.writing import trajectory_file

FUNCTIONS = '\n[controller.codes.functions]\nM21 = "M21"\nM10 = "M60==1 DWELL0"\n'
G_CODE = "O1\nT1 M6\nG21 G90 G43 H1 S8000 M3\nM21\nG0 X0. Y0. Z30.\nG1 X10. Z20. F600\nM10\nG0 Z30.\nM5 M21\nM30\n"
SIEMENS = "G90 G71 G54\nT1 M6\nS8000 M3\nM21\nG0 X0 Y0 Z30\nG1 X10 Z20 F600\nM10\nG0 Z30\nM5 M21\nM30\n"


@pytest.fixture
def machine(tmp_path):
    file = tmp_path / "machine.toml"
    file.write_text(find_machine("example_6tps").read_text(encoding="utf-8") + FUNCTIONS, encoding="utf-8")
    return file


def posted(tmp_path, name, text, machine):
    part = tmp_path / name
    part.write_text(text, encoding="ascii")
    return post_file(part, machine, arguments="--work-offset 0,0,250 --tool-length 1=60", out=tmp_path / "out")


@pytest.mark.parametrize(("name", "text"), [("part.nc", G_CODE), ("part.mpf", SIEMENS)])
def test_they_are_written_where_the_program_has_them(tmp_path, machine, name, text):
    result = posted(tmp_path, name, text, machine)
    lines = result.program.read_text(encoding="ascii").splitlines()
    codes = [line for line in lines if line in ("T1 M6", "M21", "M60==1 DWELL0", "S8000 M3", "M5")]
    assert codes == ["T1 M6", "S8000 M3", "M21", "M60==1 DWELL0", "M5", "M21"]
    (file,) = (file for file in result.files if file.suffix == ".pkmt")
    trajectory, _ = trajectory_file.read(file)
    assert [each for each in trajectory.events if each.kind is EventKind.FUNCTION] == [
        Event(0, EventKind.FUNCTION, 21.0),
        Event(len(trajectory) - 1, EventKind.FUNCTION, 10.0),
        Event(len(trajectory), EventKind.FUNCTION, 21.0),
    ]


@pytest.mark.parametrize(("name", "text"), [("part.nc", G_CODE), ("part.mpf", SIEMENS)])
@pytest.mark.parametrize(
    ("before", "after", "code"),
    [("M10\n", "M11\n", "G401"), ("F600\nM10", "F600 M10", "G437")],
    ids=["another code", "beside a move"],
)
def test_others_and_those_beside_moves_are_refused(tmp_path, machine, name, text, before, after, code):
    with pytest.raises(Refused) as refused:
        posted(tmp_path, name, text.replace(before, after), machine)
    assert [fault.code for fault in refused.value.diagnostics] == [code]


ORIENTED = '\n[controller.codes.functions]\nM19 = "M19"\n'


@pytest.mark.parametrize(("name", "text"), [("part.nc", G_CODE), ("part.mpf", SIEMENS)])
def test_an_oriented_stop_stops_the_spindle_first(tmp_path, name, text):
    machine = tmp_path / "oriented.toml"
    machine.write_text(find_machine("example_6tps").read_text(encoding="utf-8") + ORIENTED, encoding="utf-8")
    text = text.replace("M21\n", "", 1).replace("M10\n", "M19\n").replace("M5 M21", "S5000 M4\nG4 F1\nM19")
    text = text if name == "part.mpf" else text.replace("G4 F1", "G4 P1000")
    result = posted(tmp_path, name, text, machine)
    lines = result.program.read_text(encoding="ascii").splitlines()
    codes = [line for line in lines if line.startswith(("S", "M"))]
    assert codes == ["S8000 M3", "M5", "M19", "S5000 M4", "M5", "M19"]


@pytest.mark.parametrize(
    ("line", "code"), [("M19 M3", "G403"), ("G1 X2. M19", "G437"), ("M19 R90.", "G404"), ("M19 P1", "G404")]
)
def test_an_oriented_stop_stands_by_itself(tmp_path, line, code):
    machine = tmp_path / "oriented.toml"
    machine.write_text(find_machine("example_6tps").read_text(encoding="utf-8") + ORIENTED, encoding="utf-8")
    with pytest.raises(Refused) as refused:
        posted(tmp_path, "part.nc", G_CODE.replace("M21\n", "").replace("M10", line).replace("M5 M21", "M5"), machine)
    assert [fault.code for fault in refused.value.diagnostics] == [code]


def test_a_machine_without_an_oriented_stop_says_where_to_name_it(tmp_path, machine):
    with pytest.raises(Refused, match="M19: orienting the spindle; a machine that can has M19 in controller.codes"):
        posted(tmp_path, "part.nc", G_CODE.replace("M10", "M19"), machine)


@pytest.mark.parametrize(
    "entry", ['M30 = "M30"', 'M8 = "M88"', 'M98 = "M98"', 'G10 = "M10"', 'M21 = "M{value:d}"', "M21 = 21"]
)
def test_codes_that_say_how_a_program_runs_have_no_other_meaning(entry):
    text = find_machine("example_6tps").read_text(encoding="utf-8") + f"\n[controller.codes.functions]\n{entry}\n"
    found, faults = machine_of(text.encode(), "machine.toml")
    assert found is None
    assert [fault.code for fault in faults] == ["M104"]
    assert "controller.codes.functions" in faults[0].found
