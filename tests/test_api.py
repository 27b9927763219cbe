# SPDX-License-Identifier: LGPL-2.1-or-later
"""The public API: its examples, its stages against ``post``, and what it says of faults."""

import doctest
import inspect
import math
import pickle
import runpy
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from interpreter import PYTHON

import pkm_post as pkm
from pkm_post import api

ROOT = Path(__file__).parents[1]
PART = "T1 M6\nS9000 M3\nG0 X0 Y0 Z60\nG1 Z50 F600\nX10\nG2 X20 Y0 I5 J0\nG0 Z60\nM5\nM2\n"
CONTOUR = "T1 M6\nS9000 M3\nG0 X-20 Y20 Z50\nG41 D1 G1 X-10 Y0 F600\nX30\nG40 Y30\nG0 Z60\nM5\nM2\n"
PUBLIC = [each for each in vars(api).values() if inspect.isfunction(each)]
WITHOUT_FREECAD = [each for each in PUBLIC if "# in FreeCAD" not in (each.__doc__ or "")]
"""The others are run by tests/freecad_app/test_api_in_freecad.py."""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "part.ngc").write_text(PART, encoding="ascii")
    (tmp_path / "contour.ngc").write_text(CONTOUR, encoding="ascii")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_stages_of_a_post_are_there():
    named = {each.__name__ for each in PUBLIC}
    assert {"read", "place", "compensate", "reach", "plan", "write", "certify", "post"} <= named
    assert named <= set(pkm.__all__)


def test_every_name_of_the_package_is_there_and_none_is_a_room():
    rooms = {path.stem for path in (ROOT / "pkm_post").iterdir()}
    assert [name for name in pkm.__all__ if not hasattr(pkm, name) or name in rooms] == []
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = pkm.no_such_name


@pytest.mark.parametrize("function", WITHOUT_FREECAD, ids=lambda each: each.__name__)
@pytest.mark.filterwarnings("ignore::pkm_post.api.inputs.DiagnosticWarning")
def test_examples_give_what_they_say(function, folder):
    text = function.__doc__
    assert ">>>" in text
    test = doctest.DocTestParser().get_doctest(text, {"pkm": pkm, "np": np}, function.__name__, None, 0)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    said = []
    assert runner.run(test, out=said.append).failed == 0, "".join(said)


@pytest.mark.filterwarnings("ignore:.*F107:pkm_post.api.inputs.DiagnosticWarning")  # there is no manifest
def test_the_stages_give_the_program_that_post_gives(folder):
    """Each stage by itself, against the one call: the same trajectory file, and the same motion."""
    (posted,) = pkm.post("part.ngc", tool_lengths={1: 120.0}, out="posted")
    machine, program = pkm.read_machine(), pkm.read("part.ngc", tool_lengths={1: 120.0})
    trajectory = pkm.place(program, machine)
    files = pkm.write(pkm.plan(trajectory, machine), folder / "staged" / "part.pmc", machine, trajectory)
    assert {path.name for path in files} < {path.name for path in posted.files}
    for path in files:
        other = posted.program.with_name(path.name)
        assert _without_heading(path) == _without_heading(other), path.name
    certificate = pkm.certify("staged/part.pmc", machine)
    assert certificate.holds


def test_a_document_outside_freecad_is_refused_with_what_to_do(folder, monkeypatch):
    monkeypatch.delitem(sys.modules, "FreeCAD", raising=False)
    monkeypatch.setattr("pkm_post.api.functions.find_spec", lambda name: None)
    with pytest.raises(pkm.Refused) as refused:
        pkm.post("part.FCStd")
    assert [fault.code for fault in refused.value.diagnostics] == ["F143"]
    assert "python3 -m pkm_post post" in str(refused.value)


def _without_heading(path):
    return [line for line in path.read_bytes().split(b"\n") if not line.startswith(b";")]


def test_a_fault_is_refused_and_a_warning_is_issued(folder):
    (folder / "bad.ngc").write_text("G1 X10\n", encoding="ascii")
    with pytest.raises(pkm.Refused):
        pkm.read("bad.ngc")
    (folder / "long.ngc").write_text(PART.replace("X10\n", "X10\nG4 P100\n"), encoding="ascii")
    with pytest.warns(pkm.DiagnosticWarning, match="G428"):
        pkm.read("long.ngc", tool_lengths={1: 120.0})


def test_a_warning_is_of_the_line_that_called(folder):
    (folder / "long.ngc").write_text(PART.replace("X10\n", "X10\nG4 P100\n"), encoding="ascii")
    with pytest.warns(pkm.DiagnosticWarning) as issued:
        pkm.read("long.ngc", tool_lengths={1: 120.0})
    assert {Path(each.filename) for each in issued} == {Path(__file__)}


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda program: pkm.read(None), "source: expected the path of a file or a CAM job, got NoneType"),
        (lambda program: pkm.post(each for each in ["part.ngc"]), "expected the path .* got generator"),
        (lambda program: pkm.read("part.ngc", 120.0), "read: tool_lengths: expected Mapping, got float 120.0"),
        (lambda program: pkm.read("part.ngc", np.array([120.0])), "tool_lengths: expected Mapping, got ndarray"),
        (lambda program: pkm.read("part.ngc", arguments=["--unit", "mm"]), "read: arguments: expected str, got list"),
        (lambda program: pkm.read("part.ngc", reading="mm"), "reading: expected ReadingOptions, got str 'mm'"),
        (lambda program: pkm.read_options(["--unit"]), "read_options: arguments: expected str, got list"),
        (lambda program: pkm.read_machine(b"example_6tps"), "read_machine: name: expected str or Path, got bytes"),
        (lambda program: pkm.find_machine(None), "find_machine: name: expected str or Path, got NoneType"),
        (lambda program: pkm.compensate("part.ngc"), "program: expected Program, as made by pkm.read, got str 'part"),
        (lambda program: pkm.place(program, "example_6tps"), "machine: expected Machine, as made by pkm.read_machine"),
        (lambda program: pkm.place(program, pkm.read_machine(), {}), "options: expected Options or None, .* got dict"),
        (lambda program: pkm.plan(program, pkm.read_machine()), "expected Trajectory, as made by pkm.place, got Prog"),
        (lambda program: pkm.reach(program, pkm.read_machine()), "reach: trajectory: expected Trajectory"),
        (lambda program: pkm.write(None, "a.ngc"), "what: expected Program or Trajectory or Plan, as made by pkm.read"),
        (lambda program: pkm.write(program, "a.ngc", form="vector"), "form: expected GcodeDialect, got str 'vector'"),
        (lambda program: pkm.certify("part.pmc", "example_6tps"), "certify: machine: expected Machine"),
        (
            lambda program: pkm.post("part.ngc", pkm.read_machine()),
            "machine: expected str or Path or None, got Machine",
        ),
        (lambda program: pkm.post("part.ngc", options="--unit mm"), "options: expected Options or None"),
        (lambda program: pkm.post("part.ngc", log="log"), "post: log: expected Callable, got str 'log'"),
    ],
)
def test_an_argument_of_another_type_is_named(folder, call, said):
    program = pkm.read("part.ngc", tool_lengths={1: 120.0})
    before = sorted(folder.iterdir())
    with pytest.raises(TypeError, match=said):
        call(program)
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize(
    "lengths", [{1: math.inf}, {1: math.nan}, {1: 0}, {1: -5.0}, {1: "long"}, {"1": 120.0}, {1.5: 120.0}, {1: None}]
)
def test_gauge_lengths_are_checked_as_on_the_command_line(folder, lengths):
    for call in (pkm.read, pkm.post):
        with pytest.raises(ValueError, match=r"tool_lengths: expected mm by tool number, as {1: 120.0}, got {"):
            call("part.ngc", tool_lengths=lengths)


@pytest.mark.parametrize(
    ("choice", "error"),
    [
        ({"tip_tolerance": 0.0}, ValueError),
        ({"tip_tolerance": -1.0}, ValueError),
        ({"tip_tolerance": math.nan}, ValueError),
        ({"tip_tolerance": "0.1"}, ValueError),
        ({"axis_tolerance": math.inf}, ValueError),
        ({"work_offset": (0.0, 0.0, 250.0)}, ValueError),
        ({"work_offset": np.full((4, 4), math.nan)}, ValueError),
        ({"work_offset": np.diag([1.0, 1.0, -1.0, 1.0])}, ValueError),
        ({"optional_stops": "skip"}, ValueError),
        ({"report_unit": "cm"}, ValueError),
        ({"also": "csv"}, TypeError),
        ({"spin": "zero"}, TypeError),
        ({"actual_tools": None}, TypeError),
        ({"actual_tools": {1: 9.6}}, TypeError),
        ({"surface_speed": 100.0}, TypeError),
        ({"from_line": 12}, TypeError),
        ({"side": 0}, ValueError),
        ({"side": "1"}, ValueError),
    ],
)
def test_options_are_checked_as_on_the_command_line(choice, error):
    """A tolerance of 0 used to plan without end, one below it to ask for terabytes."""
    with pytest.raises(error, match=f"^{next(iter(choice))}: expected "):
        pkm.Options(**choice)
    assert pkm.Options(work_offset=np.eye(4), tip_tolerance=np.float64(0.1)).tip_tolerance == 0.1


@pytest.mark.parametrize(
    ("choice", "error"),
    [
        ({"machine_zero": (math.nan, 0.0, 0.0)}, ValueError),
        ({"machine_zero": (0.0, 0.0)}, ValueError),
        ({"machine_zero": 5.0}, ValueError),
        ({"work_offsets": {"G54": (0.0, 0.0, 0.0)}}, ValueError),
        ({"machine_offsets": {"G54": ("0", "b", "0", "0")}}, ValueError),
        ({"work_offsets": {"G54": (0.0, 0.0, math.inf, 0.0)}}, ValueError),
        ({"left_out": "M21"}, TypeError),
        ({"subprograms": "folder"}, TypeError),
    ],
)
def test_facts_about_a_part_program_are_checked(choice, error):
    with pytest.raises(error, match=f"^{next(iter(choice))}: .*expected "):
        pkm.ReadingOptions(**choice)


def test_arrays_and_paths_are_as_good_as_tuples_and_texts(tmp_path):
    part, table, sub = tmp_path / "part.ngc", tmp_path / "tools.csv", tmp_path / "sub"
    part.write_text("G21\nT1 M6\nG55 G0 X1 Y2 Z-3\nM98 P7\nG28 Z-2\nM2\n", encoding="ascii")
    table.write_text("number,diameter\n1,5\n", encoding="ascii")
    sub.mkdir()
    (sub / "7.ngc").write_text("O7\nG0 X4\nM99\n", encoding="ascii")
    zero, offset = [0.0, 0.0, 0.0], [10.0, 0.0, 0.0, 0.0]
    plain = pkm.ReadingOptions(
        machine_zero=tuple(zero), work_offsets={"G55": tuple(offset)}, subprograms=(str(sub),), unit="mm"
    )
    arrays = pkm.ReadingOptions(
        machine_zero=np.array(zero), work_offsets={"G55": np.array(offset)}, subprograms=(sub,), unit="mm"
    )
    assert arrays == plain
    plain, arrays = replace(plain, tool_table=f"{table},mm"), replace(arrays, tool_table=Path(f"{table},mm"))
    one, other = (pkm.read(part, tool_lengths={1: 120.0}, reading=each) for each in (plain, arrays))
    assert one.position.tolist() == other.position.tolist() == [[11, 2, -3], [14, 2, -3], [14, 2, -2], [14, 2, 0]]
    assert other.tools[1].diameter == 5.0


def test_what_does_not_apply_to_the_source_is_refused(folder):
    with pytest.raises(ValueError, match="job_name: expected None except for a FreeCAD document, got 'Job'"):
        pkm.post("part.ngc", tool_lengths={1: 120.0}, job_name="Job")
    with pytest.raises(ValueError, match="reading: expected none except for a part program"):
        pkm.post("part.FCStd", reading=pkm.ReadingOptions(unit="mm"))


def test_a_plan_is_not_written_over_by_its_trajectory(folder):
    machine = pkm.read_machine()
    trajectory = pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), machine)
    with pytest.raises(ValueError, match=r"expected a motion program, .* got part\.PKMT"):
        pkm.write(pkm.plan(trajectory, machine), "part.PKMT", machine, trajectory)
    assert not (folder / "part-setup.pmc").exists()


def test_a_refusal_reads_the_same_behind_a_pool_of_processes():
    with pytest.raises(pkm.Refused) as refused:
        pkm.read("no_such_file.ngc")
    again = pickle.loads(pickle.dumps(refused.value))
    assert str(again) == str(refused.value) and again.diagnostics == refused.value.diagnostics


def test_a_reach_report_reads_the_same_behind_a_pool_of_processes(folder):
    machine = replace(pkm.read_machine(), strut_speed=1.0)  # so that each kind of finding occurs
    report = pkm.reach(pkm.place(pkm.read("part.ngc", tool_lengths={1: 120.0}), machine), machine)
    again = pickle.loads(pickle.dumps(report))
    assert again.as_dict() == report.as_dict() and again.text() == report.text()
    assert again.faults() == report.faults() != ()


def test_numbers_of_numpy_and_paths_of_both_kinds_are_taken(folder):
    program = pkm.read(folder / "part.ngc", {np.int64(1): np.float32(120.0)})
    assert program.tools[1].length == 120.0
    assert pkm.find_machine(Path("example_6tps")) == pkm.find_machine("example_6tps")


@pytest.mark.parametrize("name", ["none.toml", "folder.toml", "a\0b.toml", "no_such_machine"])
def test_a_machine_file_that_is_not_there_is_refused(folder, name):
    (folder / "folder.toml").mkdir()
    with pytest.raises(pkm.Refused, match="M101"):
        pkm.find_machine(name)


@pytest.mark.parametrize("name", ["", "a\0b", "n" * 300])
def test_files_that_cannot_be_there_are_refused(folder, name):
    for call in (
        lambda: pkm.read(f"x{name}.ngc"),
        lambda: pkm.certify(f"{name}.pmc" if name else "", pkm.read_machine()),
    ):
        with pytest.raises(pkm.Refused, match="F103"):
            call()


def test_what_are_no_numbers_is_refused_by_name():
    with pytest.raises(TypeError, match="^tip_from_contact: cutter: expected Cutter, got NoneType"):
        pkm.tip_from_contact([[0, 0, 0]], [[0, 0, 1]], [[0, 0, 1]], None)
    for points in ("abc", (point for point in [(0, 0, 0)]), [[None, {}, 1.0]]):
        with pytest.raises(ValueError, match=r"^tip_from_contact: expected 3 arrays \(N, 3\) of numbers: "):
            pkm.tip_from_contact(points, [[0, 0, 1]], [[0, 0, 1]], pkm.Cutter(0.0, 5.0, 0.0))


def test_what_is_said_of_options_holds_what_was_typed():
    with pytest.raises(ValueError, match="^unknown: --unti, perhaps --unit; mm in '--unti mm'$"):
        pkm.read_options("--unti mm")


def test_a_program_is_written_as_g_code_and_read_again(folder):
    program = pkm.read("part.ngc", tool_lengths={1: 120.0})
    (copy,) = pkm.write(program, "copy.ngc")
    again = pkm.read(copy, tool_lengths={1: 120.0}, reading=pkm.ReadingOptions(axis_words="vector"))
    np.testing.assert_allclose(again.position, program.position, atol=1e-4)


def test_writing_is_refused_where_a_folder_cannot_be_made(folder):
    program = pkm.read("part.ngc", tool_lengths={1: 120.0})
    (folder / "taken").write_text("", encoding="ascii")
    with pytest.raises(pkm.Refused, match="F1"):
        pkm.write(program, folder / "taken" / "copy.ngc")


def test_a_type_checker_sees_the_types_of_the_package():
    assert (ROOT / "pkm_post" / "py.typed").is_file()


def test_importing_the_package_imports_no_numpy():
    code = "import sys; sys.modules['numpy'] = None; import pkm_post; print(pkm_post.__version__)"
    ran = subprocess.run([PYTHON, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=300, check=False)
    assert ran.stdout.strip() == pkm.__version__, ran.stderr


def test_the_page_is_up_to_date():
    page = runpy.run_path(str(ROOT / "tools" / "make_api_doc.py"))["page"]
    assert (ROOT / "docs" / "api.md").read_text(encoding="utf-8") == page(api), "run tools/make_api_doc.py"
