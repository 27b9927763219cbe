# SPDX-License-Identifier: LGPL-2.1-or-later
"""Memory runs out in each module once, at each rename, and in earnest: one diagnostic, no result, nothing left."""

import errno
import gc
import os
import subprocess
import sys
import weakref

import numpy as np
import pytest
from interpreter import PYTHON
from lack_of_memory import WHAT, lacking, place_of, traced
from programs import cone

import pkm_post
from pkm_post.cli import main
from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Refused
from pkm_post.options import Options
from pkm_post.posting import post, step_names
from pkm_post.system.out_of_memory import memory_guard

GCODE = "T1 M6\nS1000 M3\nG0 X0 Y0 Z60\nG1 X10 F600\nG2 X20 Y0 I5 J0\nM5\nM2\n"
CLDATA = "UNITS/MM\nLOADTL/1,LENGTH,120.0\nFEDRAT/MMPM,600\nGOTO/0,0,60\nGOTO/10,0,60\nEND\nFINI\n"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sources")
    (folder / "part.ngc").write_text(GCODE, encoding="ascii")
    (folder / "part.cls").write_text(CLDATA, encoding="ascii")
    made = folder / "made"
    assert main(["post", str(folder / "part.ngc"), "--tool-length", "1=120", "--out", str(made)]) == 0
    return folder


COMMANDS = {
    "machine check": "machine check example_6tps",
    "check G-code": "check {files}/part.ngc",
    "check CL data": "check {files}/part.cls",
    "convert": "convert {files}/part.ngc --to gcode:3axis --out {out}/part.ngc",
    "post": "post {files}/part.ngc --tool-length 1=120 --also csv,linuxcnc --out {out}",
    "verify": "verify {files}/made/part.pmc --against {files}/made/part.pkmt",
    "reach": "reach {files}/part.ngc --tool-length 1=120 --place",
}
"""One command for each way through the house, those with fewer modules first."""


def command(name, files, out):
    return COMMANDS[name].format(files=files, out=out).split()


def first_in_modules(arguments):
    """The function that a command enters first in each module, by module."""
    entered = {}

    def look(code):
        entered.setdefault(code.co_filename, place_of(code))
        return False

    with traced(look):
        assert main(arguments) == 0
    return entered


def left_in(folder):
    return [path.name for path in folder.rglob("*")]


def reported(errors):
    """The diagnostic that is all that was said of a lack of memory."""
    (line,) = errors.splitlines()
    assert "error F130: there is not enough memory: " in line
    assert "Traceback" not in errors
    return line


@pytest.mark.slow
def test_memory_runs_out_in_each_module_once(files, tmp_path, capsys):
    done, found = {"cli.__init__.main"}, 0  # what catches it
    for name in COMMANDS:
        stem = name.replace(" ", "-")
        out = tmp_path / stem
        places = first_in_modules(command(name, files, out))
        for place in sorted({*places.values()} - done):
            out = tmp_path / f"{stem}-{place}"
            capsys.readouterr()
            with lacking(place) as met:
                code = main(command(name, files, out))
            assert code == len(met), place
            if not met:  # its value was kept from the first time
                continue
            found += 1
            assert WHAT in reported(capsys.readouterr().err), place
            assert not left_in(out), place
        done.update(places.values())
    assert found > 150


STEPS = {
    "trajectory": "trajectory_of",
    "reach and feed plan": "plan_feed",
    "collisions": "setup_names",
    "interpolation": "interpolate",
    "motion program": "summary.heading",
    "certificate": "certify",
    "report": "summary.report",
    "also csv": "outputs.write_table",
    "also linuxcnc": "outputs.write_for_linuxcnc",
}
"""What each step calls."""


@pytest.mark.slow
@pytest.mark.parametrize("step", step_names(Options(also=("csv", "linuxcnc"))))
def test_the_step_that_lacked_memory_is_named(files, tmp_path, capsys, monkeypatch, step):
    def lack(*_, **__):
        raise MemoryError(WHAT)

    monkeypatch.setattr(f"pkm_post.posting.steps.{STEPS[step]}", lack)
    assert main(command("post", files, tmp_path / "out")) == 1
    assert f"{WHAT}, in the step {step}" in reported(capsys.readouterr().err)
    assert left_in(tmp_path / "out") == []


@pytest.mark.slow
@pytest.mark.parametrize("call", range(6))
@pytest.mark.parametrize("name", ["fsync", "replace", "listdir"])
def test_memory_runs_out_while_files_get_their_names(files, tmp_path, capsys, monkeypatch, name, call):
    calls, real = [], getattr(os, name)

    def lacking_once(*arguments, **options):
        calls.append(arguments)
        if len(calls) == call + 1:
            raise MemoryError(WHAT)
        return real(*arguments, **options)

    monkeypatch.setattr(os, name, lacking_once)
    code = main(command("post", files, tmp_path / "out"))
    monkeypatch.undo()
    if len(calls) <= call:
        assert code == 0
        return
    assert code == 1
    assert WHAT in reported(capsys.readouterr().err)
    assert left_in(tmp_path / "out") == []


@pytest.mark.slow
@pytest.mark.parametrize("place", ["report.page.write_page", "report.plots.draw_report", "report.animated_png.no_such"])
def test_memory_runs_out_while_the_report_is_drawn(files, tmp_path, capsys, place):
    with lacking(place) as met:
        code = main([*command("post", files, tmp_path / "out"), "--also", "picture"])
    assert code == int(bool(met))
    assert bool(met) == (not left_in(tmp_path / "out"))


def test_each_of_several_files_is_by_itself(files, tmp_path, capsys):
    """The second file is posted when memory ran out for the first."""
    arguments = command("post", files, tmp_path / "out")
    arguments[1:2] = [f"{files}/part.ngc", f"{files}/part.cls"]
    (tmp_path / "part2.cls").write_text(CLDATA, encoding="ascii")
    arguments[1:3] = [f"{files}/part.ngc", str(tmp_path / "part2.cls"), "--jobs", "1"]
    with lacking("reading.gcode.read.read") as met:
        assert main(arguments) == 1
    assert met
    assert "part.ngc: error F130" in capsys.readouterr().err
    assert {"part2.pmc", "part2.pkmt"} <= {*left_in(tmp_path / "out")}
    assert "part.pmc" not in left_in(tmp_path / "out")


def test_macros_get_a_refusal(files, tmp_path):
    for place in ("machine.description.reader.machine_of", "reading.gcode.read.read", "certificate.certify.certify"):
        with lacking(place), pytest.raises(Refused) as refused:
            pkm_post.post(files / "part.ngc", out=tmp_path / "out", arguments="--tool-length 1=120")
        assert [item.code for item in refused.value.diagnostics] == ["F130"]
    machine, _ = read_machine(find_machine("example_6tps"))
    with lacking("planning.feed_plan.tool_path"), pytest.raises(Refused, match="in the step reach and feed plan"):
        post(cone(8), machine, tmp_path / "out" / "part.pmc")
    assert left_in(tmp_path / "out") == []


@pytest.mark.parametrize(
    "fault",
    [
        MemoryError(),
        OSError(errno.ENOMEM, "Cannot allocate memory"),
        RuntimeError("can't start new thread"),
        ImportError("/lib/ft2font.so: failed to map segment from shared object"),
    ],
)
def test_all_ways_to_say_it_are_taken(fault):
    with pytest.raises(Refused) as refused, memory_guard("part.ngc"):
        raise fault
    (diagnostic,) = refused.value.diagnostics
    assert (diagnostic.code, diagnostic.place.file) == ("F130", "part.ngc")
    assert diagnostic.found


def test_a_process_that_cannot_start_for_lack_of_memory_is_one_line_of_a_batch(files, tmp_path, monkeypatch, capsys):
    def start(*words, **options):
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    monkeypatch.setattr(subprocess, "Popen", start)
    (tmp_path / "jobs.toml").write_text(f"[[jobs]]\nfile = '{files / 'part.ngc'}'\n", encoding="utf-8")
    assert main(["batch", str(tmp_path / "jobs.toml"), "--jobs", "1"]) == 1
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith(f"{files / 'part.ngc'}: error F130: ") and "Cannot allocate memory" in said


@pytest.mark.parametrize(
    "fault",
    [ValueError("memory"), OSError(errno.ENOSPC, "full"), RuntimeError("no thread"), ImportError("no such module")],
)
def test_other_faults_pass(fault):
    with pytest.raises(type(fault)) as passed, memory_guard("part.ngc"):
        raise fault
    assert passed.value is fault


def test_what_was_held_is_free_when_it_is_reported():
    held = []

    def hold():
        columns = np.zeros(1000)
        held.append(weakref.ref(columns))
        raise MemoryError

    with pytest.raises(Refused) as refused, memory_guard("part.ngc"):
        hold()
    gc.collect()
    assert refused.value.diagnostics
    assert held[0]() is None


LIMITED = """
import resource, sys
import lark, matplotlib.backends.backend_agg, matplotlib.figure, numpy.linalg
import pkm_post.posting
from pkm_post.system import workers
from pkm_post.cli import main
if sys.argv.pop(1) == "workers":
    workers()
pages = int(open("/proc/self/statm").read().split()[0])
most = pages * resource.getpagesize() + int(sys.argv.pop(1)) * 1_000_000
resource.setrlimit(resource.RLIMIT_AS, (most, most))
sys.exit(main(sys.argv[1:]))
"""


def limited(loaded, megabytes, arguments, folder):
    """Run a command in a process that may have so much more memory than it has when all is loaded."""
    environment = os.environ | {
        "OPENBLAS_NUM_THREADS": "1",
        "MPLBACKEND": "Agg",
        "PYTHONPATH": os.pathsep.join(sys.path),
    }
    return subprocess.run(
        [PYTHON, "-c", LIMITED, loaded, str(megabytes), *arguments],
        capture_output=True, text=True, check=False, timeout=300, cwd=folder, env=environment,
    )  # fmt: skip


@pytest.fixture(scope="module")
def long_program(tmp_path_factory):
    file = tmp_path_factory.mktemp("long") / "long.ngc"
    turn = np.linspace(0, 60 * np.pi, 30_000)
    lines = [f"X{60 * np.cos(a):.4f} Y{40 * np.sin(a):.4f}" for a in turn]
    file.write_text("\n".join(["T1 M6", "G0 Z60", "G1 F3000", *lines, "M2"]), encoding="ascii")
    return file


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such limit")
@pytest.mark.parametrize(
    ("loaded", "megabytes"),
    [
        ("modules", 1),
        ("modules", 20),
        ("modules", 100),
        ("workers", 1),
        ("workers", 6),
        ("workers", 12),
        ("workers", 20),
    ],
)
def test_memory_runs_out_in_earnest(long_program, tmp_path, loaded, megabytes):
    """Before the threads have their memory, and in one step after the other."""
    run = limited(loaded, megabytes, ["post", str(long_program), "--tool-length", "1=120", "--out", "out"], tmp_path)
    assert run.returncode == 1, run.stderr
    assert reported(run.stderr)
    assert left_in(tmp_path) in ([], ["out"])
