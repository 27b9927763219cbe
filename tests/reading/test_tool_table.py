# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool tables: LinuxCNC's, with headings, and FreeCAD's libraries; what they give, and what of them is refused."""

import json
import math

import numpy as np
import pytest

from pkm_post.machine import find_machine
from pkm_post.model import Shank, Tool, errors
from pkm_post.posting.post_file import prepared_file
from pkm_post.reading import ReadingOptions, read_part_program
from pkm_post.reading.tool_table import read_tool_table

# rows as the manual of LinuxCNC 2.9 shows them, with words in any case and order
LINUXCNC = "; tools of the router\nT1 P17 Z120.5 D6 ;mill\n\nt2 d0 p2 z+90.25\nT99999 P3 D3.175 Z+0\n"
WITH_HEADINGS = "Number;Name;Diameter;Corner radius;Length;Holder\n1;mill;6;;120.5;ER20\n2;ball;8;4;;\n;;;;;\n"


def table(tmp_path, name, text, unit=""):
    (tmp_path / name.partition(",")[0]).write_text(text, encoding="utf-8")
    return read_tool_table(f"{tmp_path / name}{unit}")


def test_a_table_of_linuxcnc(tmp_path):
    found, faults = table(tmp_path, "tools.tbl", LINUXCNC, ",mm")
    assert not faults
    assert found.lengths == {1: 120.5, 2: 90.25}
    assert found.tools == {
        1: Tool(1, "mill", 6.0, 0.0, 0.0, corner_known=False),
        99999: Tool(99999, "", 3.175, 0.0, 0.0, corner_known=False),
    }


def test_a_table_in_inches(tmp_path):
    found, _ = table(tmp_path, "tools.TBL", "T1 P1 Z2 D.25\n", ",inch")
    assert (found.lengths[1], found.tools[1].diameter) == (50.8, 6.35)


def test_a_table_with_headings(tmp_path):
    found, faults = table(tmp_path, "tools.csv", WITH_HEADINGS, ",mm")
    assert not faults
    assert found.lengths == {1: 120.5}
    assert found.tools == {1: Tool(1, "mill", 6.0, 0.0, 0.0, corner_known=False), 2: Tool(2, "ball", 8.0, 4.0, 0.0)}


def bit(shape, **parameters):
    return {"version": 2, "name": shape, "shape": f"{shape}.fcstd", "parameter": parameters, "attribute": {}}


BITS = {
    "end.fctb": bit(
        "endmill", Diameter="5.0000 mm", Length="50.0000 mm", CuttingEdgeHeight="30 mm", ShankDiameter="3 mm"
    ),
    "ball.fctb": bit("ballend", Diameter="0.25 in"),
    # FreeCAD 1.0 keeps the radius of the flat, 1.1 that of the corner
    "bull.fctb": bit("bullnose", Diameter="10.0 mm", FlatRadius="3.0 mm"),
    "new.fctb": bit("bullnose", Diameter="10.0 mm", CornerRadius="1.0 mm") | {"shape-type": "Bullnose"},
    "v.fctb": bit("v-bit", Diameter="10 mm", CuttingEdgeHeight="1 mm", ShankDiameter="5 mm", TipDiameter="1 mm"),
    "drill.fctb": bit("drill", Diameter="5 mm", TipAngle="119.0 \u00b0"),
}


def test_a_library_of_freecad(tmp_path):
    (tmp_path / "Library").mkdir()
    (tmp_path / "Bit").mkdir()
    for name, content in BITS.items():
        (tmp_path / "Bit" / name).write_text(json.dumps(content), encoding="utf-8")
    tools = [{"nr": number, "path": name} for number, name in enumerate(BITS, 1)]
    library = tmp_path / "Library" / "shop.fctl"
    library.write_text(json.dumps({"tools": tools, "version": 1}), encoding="utf-8")
    found, faults = read_tool_table(str(library))
    assert not faults
    assert found.lengths == {}
    sizes = [(tool.diameter, tool.corner_radius, tool.corner_known) for tool in found.tools.values()]
    assert found.shanks == {1: Shank(30.0, 3.0)}
    assert sizes == [(5, 0, True), (6.35, 3.175, True), (10, 2, True), (10, 1, True), (10, 0, False), (5, 0, True)]
    assert found.tools[6].bottom_angle == pytest.approx(math.radians(90 - 119 / 2))
    assert found.cores == {5: 1.0}
    (tmp_path / "Bit" / "end.fctb").unlink()
    assert "'end.fctb'" in read_tool_table(str(library))[1][0].found


def library_of(folder, shape="endmill", **parameters):
    """A library of one bit, T1."""
    (folder / "end.fctb").write_text(json.dumps(bit(shape, **parameters)), encoding="utf-8")
    library = folder / "shop.fctl"
    library.write_text(json.dumps({"tools": [{"nr": 1, "path": "end.fctb"}]}), encoding="utf-8")
    return library


QUANTITIES = {"6,35 mm": 6.35, '1/4"': 6.35, "1' 2\" + 3/8\"": 365.125, '2" + 3/8"': 60.325, "62.50 thou": 1.5875,
              "0.5 ft": 152.4, "50.00 \u00b5m": 0.05, '.5"': 12.7, "0.64 cm": 6.4, "0.01 m": 10.0}  # fmt: skip
"""Lengths as FreeCAD writes them in its unit systems, and in countries with a decimal comma."""


@pytest.mark.parametrize("text", QUANTITIES)
def test_lengths_in_every_unit_system_of_freecad(tmp_path, text):
    found, faults = read_tool_table(str(library_of(tmp_path, Diameter=text)))
    assert not faults
    assert found.tools[1].diameter == pytest.approx(QUANTITIES[text], rel=1e-12)


ANGLES = {"60.50 \u00b0": 60.5, "60,50 deg": 60.5, "60.50\u00b0": 60.5, "60\u00b0": 60.0, "60\u00b030\u2032": 60.5,
          "118\u00b07\u203223\u2033": 118.12306}  # fmt: skip
"""Angles as FreeCAD 1.0 and 1.1 write them in their unit systems."""


@pytest.mark.parametrize("text", ANGLES)
def test_angles_in_every_unit_system_of_freecad(tmp_path, text):
    """Those in minutes were no angles, and the point of the drill was not known."""
    found, _ = read_tool_table(str(library_of(tmp_path, "drill", Diameter="5 mm", TipAngle=text)))
    assert math.degrees(found.tools[1].bottom_angle) == pytest.approx(90 - ANGLES[text] / 2, abs=1e-5)


@pytest.mark.parametrize("text", ["6", "1/0 in", '1/4" 3', "6 mm mm", "1,5,5 mm", "", "0", "-3 mm"])
def test_what_is_no_length_above_zero_is_refused(tmp_path, text):
    found, ((fault),) = read_tool_table(str(library_of(tmp_path, Diameter=text)))
    assert (found, fault.code) == (None, "L447")


def test_the_shank_is_that_of_the_table_unless_the_tool_is_another(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G21\nT1 M6\nS1000 M3\nG0 X0 Y0 Z30\nG1 X10 F300\nM5\nM2\n", encoding="ascii")
    stated = {"Diameter": "5 mm", "CuttingEdgeHeight": "30 mm", "ShankDiameter": "8 mm"}
    table = f"--tool-table {library_of(tmp_path, **stated)} --tool-length 1=60"
    assert prepared_file(part, arguments=table).options.setup.shanks == {1: Shank(30.0, 8.0)}
    assert prepared_file(part, arguments=f"{table} --tool 1=6").options.setup.shanks == {}
    for name in ("CuttingEdgeHeight", "ShankDiameter"):
        library_of(tmp_path, **(stated | {name: "0.00 mm"}))
        assert prepared_file(part, arguments=table).options.setup.shanks == {}


@pytest.mark.parametrize(
    ("shape", "sizes", "core", "outline"),
    [
        ("thread-mill", {"NeckDiameter": "3 mm", "NeckLength": "20 mm"}, 3.0, (5.0, 0, 0)),
        ("radius", {"TipDiameter": "2 mm", "CuttingEdgeHeight": "14 mm"}, 2.0, (5.0, 0, 0)),
        ("v-bit", {"CuttingEdgeAngle": "90.00 \u00b0", "TipDiameter": "0.50 mm"}, None, (0.5, 0, 45)),
        ("v-bit", {"CuttingEdgeAngle": "90.00 \u00b0", "TipDiameter": "0.00 mm"}, None, (5.0, 45, 0)),
        ("v-bit", {"TipDiameter": "0.50 mm"}, 0.5, (5.0, 0, 0)),
        ("drill", {"TipAngle": "118,00 \u00b0"}, None, (5.0, 31, 0)),
        ("drill", {}, 0.1, (5.0, 0, 0)),
    ],
)
def test_tools_cut_for_certain_what_their_outline_contains(tmp_path, shape, sizes, core, outline):
    """Of another outline than that of end mills, they counted as balls of their diameter."""
    part = tmp_path / "part.ngc"
    part.write_text("G21\nT1 M6\nS1000 M3\nG0 X0 Y0 Z30\nG1 X10 F300\nM5\nM2\n", encoding="ascii")
    library = library_of(tmp_path, shape, Diameter="5 mm", ShankDiameter="4 mm", **sizes)
    prepared = prepared_file(part, arguments=f"--tool-table {library} --tool-length 1=60")
    (tool,), setup = prepared.program.tools.values(), prepared.options.setup
    assert setup.cores == ({} if core is None else {1: core})
    angles = np.degrees([tool.bottom_angle, tool.side_angle])
    assert [tool.diameter, *angles] == pytest.approx(outline)
    other = prepared_file(part, arguments=f"--tool-table {library} --tool-length 1=60 --tool 1=6,0")
    assert (other.options.setup.cores, other.program.tools[1].bottom_angle) == ({}, 0.0)


@pytest.mark.parametrize("suffix", [".ngc", ".mpf"])
def test_compensation_does_not_guess_the_diameter_of_a_tool_that_widens(tmp_path, suffix):
    """FreeCAD writes 5 mm into the table of LinuxCNC, and at its tip the cutter has 0.5 mm."""
    part = tmp_path / f"part{suffix}"
    part.write_text("G17 G90\nT1 M6\nS1000 M3\nG0 X0 Y0 Z30\nG1 G41 X10 F300\nY20\nG40 X0\nM5\nM30\n", "ascii")
    library = library_of(tmp_path, "v-bit", Diameter="5 mm", TipDiameter="0.5 mm", CuttingEdgeAngle="90 \u00b0")
    options = f"--tool-table {library} --tool-length 1=60"
    (fault,) = prepared_file(part, arguments=options).found
    assert (fault.code, fault.place.line, fault.found) == ("G411", 5, "T1, whose side leans by 45 degrees")
    prepared = prepared_file(part, arguments=f"{options} --tool 1=5")
    assert not errors(prepared.found) and prepared.program.position[:, 0].min() < 10


def old_tool(kind, **sizes):
    """A tool as the tool manager of FreeCAD 0.18 exports it (PathToolLibraryManager.py, Tool.templateAttrs)."""
    flat = {"cornerRadius": 0.0, "cuttingEdgeAngle": 180.0, "cuttingEdgeHeight": 20.0, "flatRadius": 0.0}
    return flat | {"name": kind, "tooltype": kind, "material": "Carbide", "version": 1, "lengthOffset": 0.0} | sizes


def test_an_older_table_of_freecad(tmp_path):
    tools = {
        "1": old_tool("EndMill", diameter=6.0, cornerRadius=1.0, lengthOffset=50.5),
        "2": old_tool("BallEndMill", diameter=5.0),
        "3": old_tool("Drill", diameter=3.2),
        "12": old_tool("EndMill", diameter=0.0, lengthOffset=40.0),
    }
    text = json.dumps([{"TableName": "Tool Table-1", "Version": 1, "Tools": tools}])
    found, faults = table(tmp_path, "tools.json", text, "")
    assert not faults
    sizes = {number: (each.diameter, each.corner_radius, each.corner_known) for number, each in found.tools.items()}
    assert sizes == {1: (6, 1, True), 2: (5, 2.5, True), 3: (3.2, 0, False)}
    assert (found.lengths, found.shanks) == ({1: 50.5, 12: 40.0}, {})


def test_a_table_of_camotics(tmp_path):
    """As FreeCAD 1.0 and 1.1 export it; Cylindrical may be any shape there, and the length is that of the bit."""
    tool = {"units": "metric", "shape": "Cylindrical", "length": 50.0, "diameter": 3.125, "description": "saw"}
    found, faults = table(tmp_path, "tools.json", json.dumps({"7": tool}), "")
    assert not faults
    assert [(each.name, each.diameter, each.corner_known) for each in found.tools.values()] == [("saw", 3.125, False)]
    assert found.lengths == {}
    assert table(tmp_path, "tools.json", json.dumps({"7": tool | {"units": "imperial"}}), "")[0] is None


FAULTS = {
    ("tools.json", ",mm", "{}"): (0, "a .json states its units: leave out mm"),
    ("tools.json", "", "{}"): (0, "no tools"),
    ("tools.json", "", "[{}, {}]"): (0, "tools.json is no library of FreeCAD, nor one table"),
    ("tools.json", "", '{"1": 5}'): (0, "tool '1', expected one of FreeCAD's older tables"),
    ("tools.json", "", '{"TableName": "", "Tools": {"a": {}}}'): (0, "'a' instead of the number of a tool"),
    ("tools.json", "", '{"TableName": "", "Tools": {"1": {"diameter": null}}}'): (0, "'None' instead of a number"),
    ("tools.tbl", "", "T1 P1 Z5\n"): (0, "a tool table of LinuxCNC does not state its unit"),
    ("tools.csv", "", "number,length\n1,5\n"): (0, "a table does not state its unit"),
    ("tools.tbl", ",mm", "T1 P1 Z5\nT1 P2 Z6\n"): (2, "tool 1 for the second time"),
    ("tools.tbl", ",mm", "T1 P1 Z-5\n"): (1, "length -5 mm of tool 1, expected more than 0"),
    ("tools.tbl", ",mm", "P1 Z5\n"): (1, "'P1 Z5', expected words such as T1 P1 Z50 D6"),
    ("tools.tbl", ",mm", "T1 P1 Z5 G1\n"): (1, "'T1 P1 Z5 G1', expected words"),
    ("tools.tbl", ",mm", "T1 P1 Z5..2\n"): (1, "'5..2' instead of a number"),
    ("tools.tbl", ",mm", "T1 P1 X0 Y-2 Z5\n"): (1, "offset Y-2, expected 0"),
    ("tools.tbl", ",mm", "T1.5 P1 Z5\n"): (1, "'1.5' instead of the number of a tool"),
    ("tools.tbl", ",mm", "; nothing\n"): (0, "no tools"),
    ("tools.csv", ",mm", "tool,length\n1,5\n"): (1, "no column number among 'tool,length'"),
    ("tools.csv", ",mm", "number,length\n1,abc\n"): (2, "'abc' instead of a number"),
    ("tools.csv", ",mm", "number,diameter,corner_radius\n1,6,4\n"): (2, "corner radius 4 mm of tool 1"),
    ("tools.fctl", ",mm", "{}"): (0, "a library of FreeCAD states its units: leave out mm"),
    ("tools.fctl", "", "{"): (0, "tools.fctl is no JSON"),
    ("tools.fctl", "", '{"tools": 3}'): (0, "no list of tools"),
    ("tools.fctb", "", "{}"): (0, ".fctb, expected one of .tbl, .csv, .fctl, .json"),
}


@pytest.mark.parametrize("given", FAULTS, ids=[f"{name} {text[:20]!r}" for name, _, text in FAULTS])
def test_what_is_wrong_is_named(tmp_path, given):
    name, unit, text = given
    found, ((fault),) = table(tmp_path, name, text, unit)
    line, beginning = FAULTS[given]
    assert found is None
    assert (fault.code, fault.place.line) == ("L447", line)
    assert fault.found.startswith(beginning)


def test_a_table_that_is_not_there(tmp_path):
    assert read_tool_table(str(tmp_path / "none.tbl,mm"))[1][0].code == "F103"


PART = "G21\nT1 M6\nS1000 M3\nG0 X0 Y0 Z30\nG41 D1 G1 X10 Y10 F300\nX20\nG40 Y30\nG0 Z40\nM5\nM2\n"


def test_a_program_is_read_and_prepared_with_it(tmp_path):
    part, tools = tmp_path / "part.ngc", tmp_path / "tools.tbl"
    part.write_text(PART, encoding="ascii")
    tools.write_text("T1 P1 Z60 D6\nT2 P2 Z70\n", encoding="ascii")
    assert [fault.code for fault in errors(read_part_program(part, ReadingOptions())[1])] == ["G411"]
    program, _ = read_part_program(part, ReadingOptions(tool_table=f"{tools},mm"))
    assert sorted(set(program.side_offset.tolist())) == [0.0, 3.0]
    prepared = prepared_file(part, arguments=f"--tool-table {tools},mm --tool 1=8")
    assert not prepared.found
    assert (prepared.program.tools[1].length, prepared.program.side_offset.max()) == (60.0, 4.0)


def test_cl_data_have_gauge_lengths_of_it_and_keep_their_cutters(tmp_path):
    part, tools = tmp_path / "part.apt", tmp_path / "tools.csv"
    lines = ("UNITS/MM", "LOADTL/1,LENGTH,50", "CUTTER/10", "GOTO/0,0,30", "FEDRAT/600,MMPM", "GOTO/1,0,30", "FINI")
    part.write_text("\n".join(lines), encoding="ascii")
    tools.write_text("number,diameter,length\n1,6,60\n", encoding="ascii")
    prepared = prepared_file(part, arguments=f"--tool-table {tools},mm")
    (tool,) = prepared.program.tools.values()
    assert (tool.diameter, tool.length) == (10.0, 60.0)
    replaced = [fault.found for fault in prepared.found if fault.code == "J125"]
    assert replaced == ["--tool-table 1=60 instead of 50 of T1"]


def test_a_faulty_table_refuses_the_program(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text(PART, encoding="ascii")
    (tmp_path / "tools.tbl").write_text("T1 P1 Z60 D6\n", encoding="ascii")
    table = str(tmp_path / "tools.tbl")
    assert [fault.code for fault in read_part_program(part, ReadingOptions(tool_table=table))[1]] == ["L447"]
    assert [fault.code for fault in prepared_file(part, arguments=f"--tool-table {table}").found] == ["L447"]


def test_the_machine_file_names_a_table_in_its_folder(tmp_path, monkeypatch):
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    machine, part = tmp_path / "shop" / "machine.toml", tmp_path / "part.ngc"
    machine.parent.mkdir()
    machine.write_text(text + '\n[part_programs]\ntool_table = "tools.tbl,mm"\n', encoding="utf-8")
    (machine.parent / "tools.tbl").write_text("T1 P1 Z60 D6\n", encoding="ascii")
    (tmp_path / "own.tbl").write_text("T1 P1 Z70 D6\n", encoding="ascii")
    part.write_text(PART, encoding="ascii")
    monkeypatch.chdir(tmp_path)
    assert prepared_file(part, machine).program.tools[1].length == 60.0
    assert prepared_file(part, machine, arguments="--tool-table own.tbl,mm").program.tools[1].length == 70.0
