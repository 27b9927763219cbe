# SPDX-License-Identifier: LGPL-2.1-or-later
"""One job posted through every door: what the job says holds everywhere, what is typed goes before it, with a warning.

The other opinion is the pipeline itself, called with options that were put together here.
"""

import random
import re
import shlex
from dataclasses import replace

import FreeCAD as App
import numpy as np
import pytest
from cam_jobs import add_operation
from meshes import binary_stl
from option_examples import ADDED, FLAGS, words
from Path.Post.Processor import PostProcessorFactory

import pkm_post
from pkm_post.cli import main
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import placed_job, prepared_job, setup_of, study_job
from pkm_post.freecad_app.machine_object import create_machine
from pkm_post.freecad_app.post_job import post_job
from pkm_post.machine import find_machine, machine_named
from pkm_post.model import Refused
from pkm_post.options import explicit_values, options_from, parse_text, tool_lengths_from
from pkm_post.posting import post

CUT = [
    "G0 X0 Y0 Z50 I0 J0 K1",
    "G1 X0 Y0 Z45 I0 J0.28 K0.96 F20",
    "G1 X4 Y2 Z45 I0.28 J0 K0.96 F25",
    "M1",
    "G0 Z50 I0 J0 K1",
]
ALWAYS = {"--work-offset": "--work-offset=0,0,250", "--surface-speed": "--surface-speed=100"}
"""Where the machine reaches, and what --keep-chip-load needs; in every job but where the option itself is tried."""
NO_EFFECT_HERE = {"--origin", "--corners", "--leads", "--swallowed", "--keep-climb", "--repeat-codes"}
"""They are for contours with the tool beside them, copies, and M codes of the machine, which this job has not."""
MESHES = {"far": -5000.0, "farther": -6000.0}
"""Files with a triangle so far below the part that nothing touches it, and its height, mm."""
FOR_PART_PROGRAMS = {"--tool", "--tool-table", "--unit", "--contour-data", "--wear", "--cl-dialect", "--cycle-values",
                     "--cycle-kinds", "--goto-values", "--allow-open-end", "--feed", "--flavour", "--machine-zero",
                     "--leave-out", "--subprograms", "--block-delete", "--delete-switches",
                     "--side"}  # fmt: skip
"""What G-code and CL data do not say; a job has nothing to be read so."""
NORMALS = "--actual-tool"
"""Only a path with surface normals can be posted with it."""


@pytest.fixture
def job(job, tmp_path, monkeypatch):
    """A job of a saved document, with two slow machines beside it."""
    monkeypatch.chdir(tmp_path)
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    for name, speed in (("slow", 18), ("slower", 12)):
        changed = re.sub(r"(?m)^(rapid|feed)_speed = .*$", rf"\1_speed = {speed}.0", text)
        (tmp_path / f"{name}.toml").write_text(changed, encoding="utf-8")
    for name, z in MESHES.items():
        (tmp_path / f"{name}.stl").write_bytes(binary_stl(np.array([[[0, 0, z], [9, 0, z], [0, 9, z]]])))
    add_operation(job, CUT)
    job.PostProcessor = "hexapod_pmac"
    job.Document.saveAs(str(tmp_path / "part.FCStd"))
    return job


def says(job, arguments):
    """Keep arguments in the job and in the file."""
    job.PostProcessorArgs = arguments
    job.Document.save()


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


MADE = {}
"""What the pipeline made of the job of the fixture, the same in all tests, by the arguments."""


def by_pipeline(job, arguments, folder):
    """What these arguments and no others make of a job; arguments that say the same make the same."""
    chosen = parse_text(arguments)
    said = repr(chosen)
    if said not in MADE:
        MADE[said] = made_by_pipeline(job, chosen, folder)
    return MADE[said]


def made_by_pipeline(job, chosen, folder):
    program, _ = read_job(job, tool_lengths_from(chosen))
    machine, _ = machine_named(chosen.machine)
    post(program, machine, folder / "part.pmc", replace(options_from(chosen), setup=setup_of(job)))
    return contents(folder)


def by_cam(job, arguments, folder):
    job.PostProcessorOutputFile = str(folder / "part.pmc")
    ((_, text),) = PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    assert (folder / "part.pmc").read_text(encoding="ascii") == text


def by_command_line(job, arguments, folder):
    assert main(["post", job.Document.FileName, "--out", str(folder), *arguments]) == 0


def by_panel(job, arguments, folder):
    prepared_job(job, settings_of(job)).post(folder / "part.pmc")


def by_macro(job, arguments, folder):
    pkm_post.post(job, out=folder, arguments=shlex.join(arguments))


def by_macro_with_the_file(job, arguments, folder):
    pkm_post.post(job.Document.FileName, out=folder, arguments=shlex.join(arguments))


def as_the_job_says(job, arguments, folder):
    post_job(job, out=folder)


OF_THE_JOB = [by_cam, by_panel, as_the_job_says]
"""They have nothing but the job."""
TYPED = [by_command_line, by_macro, by_macro_with_the_file]
DOORS = [*OF_THE_JOB, *TYPED]
WHERE = ["job", "command line", "both"]


def doors_for(flag, where):
    """For what the job says two doors, and one of the macros for what is typed, in turn; the command line warns."""
    turn = FLAGS.index(flag)
    if where == "job":
        return [DOORS[(2 * turn + place) % len(DOORS)] for place in range(2)]
    return [by_command_line] if where == "both" else [by_command_line, (by_macro, by_macro_with_the_file)[turn % 2]]


@pytest.mark.parametrize(
    "where", [pytest.param(where, marks=() if where == "both" else pytest.mark.slow) for where in WHERE]
)
@pytest.mark.parametrize("flag", [flag for flag in FLAGS if flag not in {NORMALS, *FOR_PART_PROGRAMS}])
def test_every_option_is_taken_at_a_door(job, tmp_path, flag, where, capsys):
    others = [text for name, text in ALWAYS.items() if name != flag]
    of_job = others + (words(flag, 0) if where != "command line" else [])
    over_it = words(flag, 1) if where != "job" else []
    says(job, shlex.join(of_job))
    wanted = by_pipeline(job, shlex.join([*of_job, *over_it]), made(tmp_path / "wanted"))
    if where == "both" and flag not in NO_EFFECT_HERE:
        assert wanted != by_pipeline(job, shlex.join(of_job), made(tmp_path / "of the job alone"))
    for door in doors_for(flag, where):
        folder = made(tmp_path / door.__name__)
        door(job, over_it, folder)
        assert contents(folder) == wanted, door.__name__
    reported = capsys.readouterr().err
    replaced = {"both": flag not in ADDED, "job": flag == "--tool-length", "command line": flag in SAID_BY_EVERY_JOB}[
        where
    ]
    assert (f"warning J125: an option overrides a value of the job or the program: {flag} " in reported) == replaced


IMPERIAL = 3
"""The unit system with inches and decimals."""


def test_the_page_of_the_report_has_the_units_of_the_document(job, tmp_path):
    says(job, ALWAYS["--work-offset"])
    in_mm, in_inch = (
        by_pipeline(job, f"{ALWAYS['--work-offset']} --report-unit {unit}", made(tmp_path / unit))
        for unit in ("mm", "inch")
    )
    assert {name for name, content in in_mm.items() if content != in_inch[name]} == {
        "part-manifest.json",
        "part-report.html",
    }
    systems = job.Document.getEnumerationsOfProperty("UnitSystem")
    assert len(systems) == 10
    for system, name in enumerate(systems):
        job.Document.UnitSystem = name
        job.Document.save()
        chosen = prepared_job(job, settings_of(job)).options.report_unit
        assert chosen == ("mm" if is_metric(system) else "inch"), name
        for door in DOORS if system == IMPERIAL else [by_panel]:
            folder = made(tmp_path / f"{door.__name__} {system}")
            door(job, [], folder)
            assert contents(folder) == (in_mm if is_metric(system) else in_inch), (door.__name__, name)
    job.Document.UnitSystem = systems[IMPERIAL]
    says(job, f"{ALWAYS['--work-offset']} --report-unit mm")
    by_panel(job, [], made(tmp_path / "said"))
    assert contents(tmp_path / "said") == in_mm


def is_metric(system):
    """Whether FreeCAD shows lengths of a part in metric units in this unit system."""
    App.Units.setSchema(system)
    try:
        return "m" in App.Units.Quantity("100 mm").getUserPreferred()[2]
    finally:
        App.Units.setSchema(0)


@pytest.mark.parametrize("flag", sorted(FOR_PART_PROGRAMS))
def test_what_is_for_part_programs_is_refused_at_every_door(job, tmp_path, flag, capsys):
    out = made(tmp_path / "out")
    says(job, ALWAYS["--work-offset"])
    for door in (by_macro, by_macro_with_the_file):
        with pytest.raises(Refused) as refused:
            door(job, words(flag, 0), out)
        assert [each.code for each in refused.value.diagnostics if each.code != "J125"] == ["L442"]
    assert main(["post", job.Document.FileName, "--out", str(out), *words(flag, 0)]) == 2
    assert f"error L442: an option does not apply to this input: {flag} is for" in capsys.readouterr().err
    says(job, shlex.join(words(flag, 0)))
    with pytest.raises(Refused, match=f"J117: .* {flag} is for"):
        prepared_job(job, settings_of(job))
    assert contents(out) == {}


SAID_BY_EVERY_JOB = {"--work-offset", "--tool-length"}
"""By its fixture and by its tool controllers."""


@pytest.mark.parametrize("where", WHERE)
def test_the_actual_tool_is_that_of_the_job_or_the_one_typed(job, where):
    says(job, shlex.join(words(NORMALS, 0)) if where != "command line" else "")
    given = explicit_values(parse_text(shlex.join(words(NORMALS, 1)))) if where != "job" else {}
    (tool,) = settings_of(job, given).options.actual_tools.values()
    assert tool.diameter == (9.5 if where == "job" else 9.0)


def made(folder):
    folder.mkdir()
    return folder


def test_a_batch_in_processes_gives_the_same_bytes(job, tmp_path):
    says(job, "--work-offset=2,1,255 --tip-tolerance 0.003 --tool-length 1=118 --machine slow.toml")
    wanted = by_pipeline(job, job.PostProcessorArgs + " --tip-tolerance 0.006", made(tmp_path / "wanted"))
    other = tmp_path / "other.FCStd"
    other.write_bytes((tmp_path / "part.FCStd").read_bytes())
    files, out = [job.Document.FileName, str(other)], tmp_path / "out"
    assert main(["post", *files, "--jobs", "2", "--out", str(out), "--tip-tolerance", "0.006"]) == 0
    made_of_both = contents(out)
    assert made_of_both["part.pmc"] == wanted["part.pmc"]
    assert made_of_both["part.pkmt"] == wanted["part.pkmt"]
    assert {"other.pmc", "other.pkmt"} < set(made_of_both)


def test_reach_and_simulation_see_the_job_where_it_is_posted(job):
    says(job, "--work-offset=2,1,255,10 --tool-length 1=118 --machine slow.toml --spin x-in-plane=15")
    posted, _ = prepared_job(job, settings_of(job)).placed()
    simulated = placed_job(job)
    assert simulated.machine.fingerprint == posted.machine_fingerprint
    for trajectory in (simulated.trajectory, study_job(job).reach.trajectory):
        for column in ("tip", "axis", "spin", "feed"):
            assert (getattr(trajectory, column) == getattr(posted, column)).all()
        assert trajectory.tools == posted.tools


def test_no_text_depends_on_the_folder_of_the_document(job):
    says(job, "--work-offset=0,0,250 --machine slow.toml")
    job.PostProcessor = "hexapod_trajectory"
    ((_, text),) = PostProcessorFactory.get_post_processor(job, "hexapod_trajectory").export()
    assert "(machine: slow.toml)" in text


def test_a_machine_object_of_another_machine_is_reported(job, monkeypatch):
    reported = []
    monkeypatch.setattr(App.Console, "PrintWarning", reported.append)
    says(job, "--work-offset=2,1,255,10 --machine slow.toml")
    machine = create_machine(job.Document, job=job)
    job.Document.recompute()
    placed_job(job, machine)
    assert reported == []
    machine.MachineFile = "example_6tps"
    job.Document.recompute()
    placed_job(job, machine)
    assert ["--machine example_6tps instead of" in each for each in reported] == [True]
    machine.Job, machine.WorkOffset = None, App.Placement(App.Vector(0, 0, 240), App.Rotation())
    job.Document.recompute()
    placed_job(job, machine)
    assert "--work-offset 0,0,240,0 instead of 2,1,255,10" in reported[-1]


def test_a_machine_file_lies_beside_the_document_wherever_freecad_was_started(job, tmp_path, monkeypatch):
    says(job, "--work-offset=0,0,250 --machine slow.toml --fixture far.stl")
    wanted = by_pipeline(job, job.PostProcessorArgs, made(tmp_path / "wanted"))
    monkeypatch.chdir("/")
    for door in (by_cam, by_command_line):
        folder = made(tmp_path / door.__name__)
        door(job, [], folder)
        assert contents(folder) == wanted


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_arguments_by_chance(job, tmp_path, seed):
    """Some options in the job; in every second series some typed, some in both, in any order."""
    chance = random.Random(seed)
    tried = [flag for flag in FLAGS if flag not in {*ALWAYS, *NO_EFFECT_HERE, *FOR_PART_PROGRAMS, NORMALS}]
    of_job = [
        *ALWAYS.values(),
        *(word for flag in chance.sample(tried, 4) for word in words(flag, chance.randrange(2))),
    ]
    over_it = [word for flag in chance.sample(tried, 3 * (seed % 2)) for word in words(flag, chance.randrange(2))]
    chance.shuffle(of_job)
    says(job, shlex.join(of_job))
    wanted = by_pipeline(job, shlex.join([*of_job, *over_it]), made(tmp_path / "wanted"))
    for door in TYPED if over_it else DOORS:
        folder = made(tmp_path / door.__name__)
        door(job, over_it, folder)
        assert contents(folder) == wanted
