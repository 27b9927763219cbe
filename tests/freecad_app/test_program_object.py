# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part programs as document objects: opened, faulty, saved, decoded into a job, posted from there."""

import dataclasses
import re

import FreeCAD as App
import numpy as np
import pytest
from another_freecad import printed_by
from cam_jobs import add_tool_controller, moves, new_job, reopened

from pkm_post.freecad_app import program_import
from pkm_post.freecad_app.document import is_program
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.program_object import create_program, decode, read_program, reading_of, set_reading
from pkm_post.model import Refused
from pkm_post.reading import ReadingOptions

GCODE = """G21 G90 G17
T1 M6
S9000 M3
G0 X0 Y0 Z30
G1 Z5 F600
G1 X10 Y4 F900
G2 X20 Y4 I5 J0
G0 Z30
M2
"""
CLDATA = """PARTNO bracket
UNITS/MM
LOADTL/1
SPINDL/RPM,9000,CLW
RAPID
GOTO/0,0,30,0,0,1
FEDRAT/600,MMPM
GOTO/0,0,5,0,0.28,0.96
GOTO/10,4,5,0.28,0,0.96
FINI
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "part.ngc"
    path.write_text(GCODE)
    return path


def written(folder, name, text):
    path = folder / name
    path.write_text(text)
    return path


@pytest.fixture
def printed(monkeypatch):
    reported = []
    monkeypatch.setattr("pkm_post.freecad_app.program_object.print_diagnostics", reported.extend)
    return reported


@pytest.mark.parametrize("suffix", ["ngc", "nc"])
def test_gcode_is_opened_in_a_document_of_its_own(tmp_path, suffix):
    document = program_import.open(str(written(tmp_path, f"part.{suffix}", GCODE)))
    (obj,) = document.Objects
    assert is_program(obj)
    assert (obj.Label, obj.Found) == (f"part.{suffix}", [])
    cuts = [(name, words) for name, words in moves(obj) if name[0] == "G"]
    assert [name for name, _ in cuts] == ["G0", "G1", "G1", "G2", "G0"]
    assert cuts[-1][1] == {"X": 20, "Y": 4, "Z": 30}
    App.closeDocument(document.Name)


@pytest.mark.parametrize("suffix", ["ncl", "cls", "apt", "aptsource"])
def test_cl_data_is_inserted_into_a_document(document, tmp_path, suffix):
    program_import.insert(str(written(tmp_path, f"part.{suffix}", CLDATA)), document.Name)
    (obj,) = document.Objects
    assert [words["K"] for name, words in moves(obj) if name == "G1"] == pytest.approx([0.96, 0.96])


def test_faulty_file_has_no_path_and_says_why(document, tmp_path):
    obj = create_program(document, written(tmp_path, "part.ngc", "G21\nG0 X0 Y0 Z0\nG1 X1..5 F100\n"))
    assert obj.Path.Commands == []
    assert ["line 3" in text and "G102" in text for text in obj.Found] == [True]


def test_file_that_is_gone_or_has_another_suffix(document, file):
    obj = create_program(document, file)
    assert obj.Path.Commands
    file.unlink()
    obj.touch()
    document.recompute()
    assert (obj.Path.Commands, "F103" in obj.Found[0]) == ([], True)
    obj.File = str(file.with_suffix(".doc"))
    document.recompute()
    assert ".aptsource" in obj.Found[0]


def test_object_follows_its_file_and_its_axis_words(document, file):
    obj = create_program(document, file)
    leaning = GCODE.replace("G17", "G17 G43.5 H1").replace("X10 Y4", "X10 Y4 I0 J0.6 K0.8")
    file.write_text(leaning.replace("G2 X20 Y4 I5 J0", "G1 X20 I0 J0 K1"))
    obj.touch()
    document.recompute()
    assert (obj.Path.Commands, obj.Found != []) == ([], True)
    obj.AxisWords = "vector"
    document.recompute()
    assert obj.Found == []
    assert [words["J"] for name, words in moves(obj) if name == "G1"] == pytest.approx([0, 0.6, 0])


def test_object_has_a_unit_of_dwells(document, tmp_path):
    file = written(tmp_path, "part.ngc", GCODE.replace("G1 X10", "G4 P2000\nG1 X10"))
    obj = create_program(document, file)
    assert ["G428" in text for text in obj.Found] == [True]
    obj.DwellUnit = "ms"
    document.recompute()
    assert obj.Found == []
    assert [words for name, words in moves(obj) if name == "G4"] == [{"P": 2}]
    in_ms = create_program(document, file, dwell_unit="ms")
    assert moves(in_ms) == moves(obj)


CONTOUR = """TOOL PATH/P,TOOL,M
TLDATA/MILL,10,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
GOTO/-40,-10,0,0,0,1
FEDRAT/PERMIN,300
CUTCOM/LEFT
GOTO/0,-10,0
GOTO/0,50,0
CUTCOM/OFF
GOTO/-40,50,0
END-OF-PATH
"""


def code_of(reported):
    return re.search(r"(?:error|warning) (\w+):", reported)[1]


def test_what_cl_data_leaves_open_is_said_by_properties(document, tmp_path):
    obj = create_program(document, written(tmp_path, "part.cls", CONTOUR))
    assert [code_of(text) for text in obj.Found] == ["L411", "L431", "L429"]
    assert obj.Path.Commands == []
    obj.Unit = "mm"
    document.recompute()
    assert [code_of(text) for text in obj.Found] == ["L411", "L429"]
    reached = {}
    for choice in ("centre", "contour"):
        obj.ContourData = choice
        document.recompute()
        reached[choice] = max(words["X"] for name, words in moves(obj) if name == "G1" and "X" in words)
        assert not [text for text in obj.Found if "error" in text]
    assert reached == {"centre": 0, "contour": -5}
    obj.Unit = "inch"
    document.recompute()
    assert min(words["X"] for name, words in moves(obj) if "X" in words) == -40 * 25.4


def test_a_program_is_made_with_what_its_file_leaves_open(document, tmp_path):
    obj = create_program(document, written(tmp_path, "part.cls", CONTOUR), unit="mm", contour_data="centre")
    assert (obj.Unit, obj.ContourData) == ("mm", "centre")
    assert not [text for text in obj.Found if "error" in text]


CYCLES = """UNITS/MM
LOADTL/1
FEDRAT/100,MMPM
RAPID
GOTO/0,0,50
CYCLE/DRILL,{}
GOTO/10,0,0
CYCLE/OFF
FINI
"""


@pytest.mark.parametrize(
    "items, name, choices, code",
    [
        ("FEDTO,-7,RAPTO,2", "ClDialect", {"nx": -7, "creo": None}, "L419"),
        ("7.,85.,2.,MMPM", "CycleValues", {"depth,feed,clearance": -7, "depth,feed": None}, "L420"),
    ],
)
def test_what_cycles_leave_open_is_said_by_properties(document, tmp_path, items, name, choices, code):
    obj = create_program(document, written(tmp_path, "part.apt", CYCLES.format(items)))
    assert code in [code_of(text) for text in obj.Found]
    for choice, depth in choices.items():
        setattr(obj, name, choice)
        document.recompute()
        reached = [words["Z"] for kind, words in moves(obj) if kind == "G1" and "Z" in words]
        assert reached == ([depth] if depth else [])


def test_kinds_of_cycles_are_said_by_a_property(document, tmp_path):
    text = CYCLES.format("DEPTH,7,MMPM,85,CLEAR,2").replace("CYCLE/DRILL", "CYCLE/DEEPHL")
    obj = create_program(document, written(tmp_path, "part.apt", text))
    assert "L445" in [code_of(text) for text in obj.Found]
    obj.CycleKinds = "DEEPHL=drill"
    document.recompute()
    assert [words["Z"] for kind, words in moves(obj) if kind == "G1" and "Z" in words] == [-7]
    assert reading_of(obj).cycle_kinds == {"DEEPHL": "drill"}
    obj.CycleKinds = "DEEPHL=fly"
    document.recompute()
    assert "J121" in [code_of(text) for text in obj.Found]


def test_a_machine_zero_with_less_than_three_numbers_is_refused(document, tmp_path):
    obj = create_program(document, written(tmp_path, "part.ngc", GCODE))
    for numbers, codes in (([5.0], ["J121"]), ([5.0, 6.0], ["J121"]), ([5.0, 6.0, 7.0], [])):
        obj.MachineZero = numbers
        document.recompute()
        assert [code_of(text) for text in obj.Found] == codes


def test_tools_come_from_a_table_that_a_property_names(document, tmp_path):
    text = GCODE.replace("G1 X10 Y4 F900", "G41 D1 G1 X10 Y4 F900").replace("G2 X20 Y4 I5 J0\nG0", "G1 X20\nG40 G0 X30")
    obj = create_program(document, written(tmp_path, "part.ngc", text))
    assert [code_of(text) for text in obj.Found] == ["G411"]
    obj.ToolTable = f"{written(tmp_path, 'tools.tbl', 'T1 P1 Z60 D6')},mm"
    document.recompute()
    assert not [text for text in obj.Found if "error" in text]
    assert obj.Path.Commands


def test_switches_of_block_delete_have_a_property(document, tmp_path):
    text = "G21\nG0 X0 Y0 Z0\n/2 G1 X10 F100\n/3 G1 X20 F100\nG1 X30 F100\nM2\n"
    obj = create_program(document, written(tmp_path, "part.ngc", text))
    assert obj.DeleteSwitches == [] and reading_of(obj) == ReadingOptions()
    set_reading(obj, ReadingOptions(delete_switches=(2,)))
    obj.touch()
    document.recompute()
    assert [given["X"] for name, given in moves(obj) if name == "G1"] == [20.0, 30.0]
    assert reading_of(obj) == ReadingOptions(delete_switches=(2,))


def test_saved_document_keeps_the_path_without_the_file(document, file, tmp_path):
    obj = create_program(document, file)
    before, name = moves(obj), obj.Name
    file.unlink()
    again = reopened(document, tmp_path / "program.FCStd").getObject(name)
    assert type(again.Proxy).__name__ == "PartProgram"
    assert [name for name, _ in moves(again)] == [name for name, _ in before]


def test_decoded_into_a_job_it_is_the_same_program(document, file):
    obj, job = create_program(document, file), new_job(document)
    wanted, _ = read_program(obj)
    operation = decode(obj, job)
    assert (operation.Label, operation.ToolController) == ("part", job.Tools.Group[0])
    program, faults = read_job(job)
    assert faults == ()
    assert program.position == pytest.approx(wanted.position, abs=1e-6)  # mm, the decimals of FreeCAD
    assert np.array_equal(program.kind, wanted.kind)
    assert program.feed == pytest.approx(wanted.feed, abs=1e-6, nan_ok=True)
    tools = [event for event in program.events if event.kind.name == "TOOL_CHANGE"]
    assert [(event.row, event.value) for event in tools] == [(0, 1.0)]


def test_decoded_with_the_controller_of_its_tool(document, tmp_path):
    obj, job = create_program(document, written(tmp_path, "a.ngc", GCODE.replace("T1", "T7"))), new_job(document)
    with pytest.raises(Refused) as refused:
        decode(obj, job)
    assert [fault.code for fault in refused.value.diagnostics] == ["J112"]
    assert job.Operations.Group == []
    controller = add_tool_controller(job, 7)
    assert decode(obj, job).ToolController == controller


_CODES = ["G61.1", "G61", "G64 P0.05", "G0 Z2\nG81 X1 Y1 Z-3 R2 F300\nX3\nG80", "G61\nG4 P1\nG61.1"]


@pytest.mark.parametrize("code", _CODES)
def test_exact_stops_exact_paths_and_tolerances_are_decoded(document, tmp_path, printed, code):
    obj = create_program(document, written(tmp_path, "a.ngc", GCODE.replace("Z30\n", f"Z30\n{code}\n", 1)))
    wanted, _ = read_program(obj)
    job = new_job(document)
    decode(obj, job)
    program, faults = read_job(job)
    assert faults == ()
    assert printed == []
    modes = [(wanted.exact_stop, program.exact_stop), (wanted.exact_path, program.exact_path),
             (wanted.tip_tolerance, program.tip_tolerance)]  # fmt: skip
    assert any(np.any(before) for before, _ in modes)
    for before, after in modes:
        np.testing.assert_array_equal(after, before)


def test_what_an_operation_cannot_say_is_reported(document, tmp_path, printed):
    text = CLDATA.replace("0,0,30,0,0,1", "0,0,30,0,0,1,0,0,1").replace("0.96\n", "0.96,0,0,1\n")
    obj = create_program(document, written(tmp_path, "a.ncl", text))
    obj.GotoValues = "x,y,z,i,j,k,nx,ny,nz"
    document.recompute()
    printed.clear()
    decode(obj, new_job(document))
    assert [each.code for each in printed] == ["J120"]
    assert "surface normals of 3 moves" in str(printed[0])


def test_a_program_without_an_end_has_no_path_unless_it_may(document, tmp_path):
    file = written(tmp_path, "a.ngc", GCODE.replace("M2\n", ""))
    obj = create_program(document, file)
    assert [code_of(reported) for reported in obj.Found] == ["G430"]
    assert obj.Path.Commands == []
    with pytest.raises(Refused, match="G430"):
        decode(obj, new_job(document))
    obj.OpenEnd = True
    document.recompute()
    assert [code_of(reported) for reported in obj.Found] == ["V130"]
    assert moves(obj) == moves(create_program(document, file, allow_open_end=True)) != []


def test_faulty_program_is_not_decoded(document, tmp_path):
    obj = create_program(document, written(tmp_path, "a.ngc", "G1 X1\nM2\n"))
    with pytest.raises(Refused):
        decode(obj, new_job(document))


_TYPES = """
import FreeCAD
names = {suffix: FreeCAD.getImportType(suffix) for suffix in ("ngc", "nc", "ncl", "cls", "apt", "aptsource")}
print("types:", all("pkm_post.freecad_app.program_import" in modules for modules in names.values()))
"""


def test_freecad_knows_the_suffixes(tmp_path):
    script = tmp_path / "types.py"
    script.write_text(_TYPES)
    assert "types: True" in printed_by(script)


KEPT = {
    "axis_words": "vector", "unit": "inch", "contour_data": "centre", "cl_dialect": "nx",
    "cycle_values": ("depth", "feed", "clearance"), "cycle_kinds": {"XDRILL": "drill"},
    "dwell_unit": "ms", "allow_open_end": True, "flavour": "fanuc",
    "machine_zero": (1.0, 2.0, 3.0), "left_out": ("M21",), "feed": 10.0, "goto_values": ("x", "y", "z"),
    "work_offsets": {"G55": (1.0, 2.0, 3.0, 0.0)}, "block_delete": True, "delete_switches": (2,),
    "subprograms": ("/sub",), "tool_table": "tools.tbl",
}  # fmt: skip


@pytest.mark.parametrize("entry", sorted(field.name for field in dataclasses.fields(ReadingOptions)))
def test_an_entry_of_a_reading_has_a_property_or_is_refused(document, tmp_path, entry):
    file, kept = written(tmp_path, "part.ngc", GCODE), KEPT.get(entry)
    if kept is None:
        with pytest.raises(TypeError, match=f"no property for {entry}$"):
            create_program(document, file, **{entry: {}})
        assert not document.Objects
    else:
        assert getattr(reading_of(create_program(document, file, **{entry: kept})), entry) == kept
