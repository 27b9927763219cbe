# SPDX-License-Identifier: LGPL-2.1-or-later
"""What goes to the controller is what was certified, for this machine: whatever file differs, nothing is loaded."""

import copy
import dataclasses
import json
import logging
import re
import shutil
import sys
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from best_segment import deviation_from_any
from program_mutants import mutants
from programs import ON_PALLET, cone
from series import cases

sys.path.insert(0, str(Path(__file__).with_name("link")))

from rig import served  # noqa: E402

from pkm_post.certificate.deviation import TrajectoryRuler  # noqa: E402
from pkm_post.cli import main  # noqa: E402
from pkm_post.control.loading import certified, job_to_load  # noqa: E402
from pkm_post.control.simulator import Controller  # noqa: E402
from pkm_post.geometry import hermite_accelerations, hermite_lengths  # noqa: E402
from pkm_post.machine import (
    forward_along_path,  # noqa: E402
    machine_named,  # noqa: E402
)
from pkm_post.model import Event, EventKind, Refused  # noqa: E402
from pkm_post.options.choices import Options  # noqa: E402
from pkm_post.posting.steps import post  # noqa: E402
from pkm_post.posting.verify import verify  # noqa: E402
from pkm_post.toolpath import ToolPose  # noqa: E402
from pkm_post.writing import trajectory_file  # noqa: E402
from pkm_post.writing.controllers import (
    pmac,  # noqa: E402
    program_files,
)

MUTANTS = cases(25)
"""Of each program."""
STOPS = (Event(0, EventKind.TOOL_CHANGE, 1), Event(6, EventKind.STOP, 0.0), Event(9, EventKind.SPINDLE, 900.0))


def machine_of(kind="turbo_pmac", **entries):
    machine = machine_named("example_6tps")[0]
    return dataclasses.replace(machine, controller=machine.controller | {"kind": kind} | entries)


def posted_in(folder, machine):
    program = dataclasses.replace(cone(12, turns=0.1), events=STOPS)
    return post(program, machine, folder / "cone.pmc", Options(ON_PALLET, 0.001, np.radians(0.001)))


@pytest.fixture(scope="module")
def machine():
    return machine_of()


@pytest.fixture(scope="module")
def original(machine, tmp_path_factory):
    return posted_in(tmp_path_factory.mktemp("posted"), machine).program


@pytest.fixture
def program(original, tmp_path):
    """A copy of all that was posted."""
    for file in original.parent.iterdir():
        shutil.copy(file, tmp_path)
    return tmp_path / original.name


@pytest.fixture(scope="module")
def in_parts(tmp_path_factory):
    """A program in parts, and its machine."""
    machine = machine_of(memory_words=800)
    return posted_in(tmp_path_factory.mktemp("parts"), machine), machine


def codes(faults):
    return {fault.code for fault in faults}


def test_a_posted_program_is_certified_by_what_lies_beside_it(program, machine):
    found, faults = certified(program, machine)
    assert faults == () and not found.verified_now
    assert found.text == program.read_text() and found.digest == program_files.program_hash(found.text)


def test_report_and_heading_name_the_bytes(original, machine):
    report, text = json.loads(original.with_name("cone-report.json").read_text()), original.read_text()
    assert report["files"]["programs_sha256"] == [program_files.program_hash(text)]
    assert program_files.own_hash_matches(text)
    assert program_files.source_hash_matches(text, "machine", machine.fingerprint)
    assert program_files.source_hash_matches(text, "trajectory", report["files"]["trajectory_sha256"])


def test_line_ends_of_windows_are_certified(program, machine):
    program.write_bytes(program.read_bytes().replace(b"\n", b"\r\n"))
    found, _ = certified(program, machine)
    assert found is not None and not found.verified_now


@pytest.mark.parametrize("gone", ["cone-report.json", "cone-manifest.json", "cone-report.html"])
def test_what_is_missing_is_made_up_for_by_verifying_or_refused(program, machine, gone):
    program.with_name(gone).unlink()
    found, faults = certified(program, machine)
    if gone == "cone-manifest.json":
        assert found.verified_now
    else:
        assert found is None and {"C110", "F106"} <= codes(faults)


def test_without_its_trajectory_nothing_is_certified(program, machine):
    program.with_suffix(".pkmt").unlink()
    assert codes(certified(program, machine)[1]) == {"C110"}


def test_a_program_alone_is_not_certified(original, machine, tmp_path):
    alone = shutil.copy(original, tmp_path / "cone.pmc")
    assert codes(certified(alone, machine)[1]) == {"C110"}


def test_a_report_that_does_not_hold_is_not_believed(program, machine):
    report = program.with_name("cone-report.json")
    report.write_text(report.read_text().replace('"holds": true', '"holds": false'))
    assert {"C110", "F106"} <= codes(certified(program, machine)[1])


def test_another_machine_file_is_refused(program, machine):
    other = dataclasses.replace(machine, fingerprint="1" * 64)
    assert {"C110", "T104"} <= codes(certified(program, other)[1])


def test_an_edited_comment_is_refused(program, machine):
    program.write_text(program.read_text().replace("; PKM", "; pkm", 1))
    assert {"C109", "F106"} <= codes(certified(program, machine)[1])


def refused_by_verify(program, machine, text):
    program.write_text(text)
    try:
        verify(program, program.with_suffix(".pkmt"), machine)
    except Refused:
        return True
    return False


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["turbo_pmac", "power_pmac"])
def test_no_mutant_is_certified_that_verify_refuses(kind, tmp_path):
    machine = machine_of(kind)
    program = posted_in(tmp_path, machine).program
    text, refused = program.read_text(), 0
    for _, mutant in zip(range(MUTANTS), mutants(text, seed=11), strict=False):
        program.write_text(mutant)
        found, _ = certified(program, machine)
        if refused_by_verify(program, machine, mutant):
            refused += 1
            assert found is None
    assert refused == MUTANTS


def worst_of(text, trajectory, machine):
    """Deviation of the tip, mm, and highest strut acceleration, mm/s^2, in instants of all intervals.

    Poses by forward kinematics, each from the programmed pose of the segment it fits best; no part of the certificate.
    """
    struts, _ = pmac.read_program(text, pmac.settings_of(machine)[0], "cone.pmc")
    rows, shares = np.arange(len(struts) - 1), np.linspace(0, 1, 9)
    cubics = struts.cubics(rows)
    length = hermite_lengths(*cubics, shares).reshape(-1, 6)
    tool = np.full(len(length), trajectory.tool_length()[0])
    pose = forward_along_path(machine, length, tool, ToolPose.at_start(trajectory))
    assert pose.converged.all()
    ruler, every = TrajectoryRuler(trajectory, trajectory.tolerances), np.zeros(len(length), dtype=int)
    tip, _ = deviation_from_any(ruler, pose.tip, pose.axis, every, every + len(trajectory) - 1)
    return tip.max(), max(np.abs(one).max() for one in hermite_accelerations(*cubics))


@pytest.mark.slow
def test_without_seal_and_manifest_mutants_are_taken_only_when_they_do_what_was_programmed(program, machine):
    """As of an earlier version: what it does decides. An interval may be a little longer, for instance."""
    program.with_name("cone-manifest.json").unlink()
    lines = program.read_text().splitlines(keepends=True)
    bare = "".join(line for line in lines if "SHA-256" not in line)
    trajectory, _ = trajectory_file.read(program.with_suffix(".pkmt"))
    taken = []
    for mutant in (bare, *islice(mutants(bare, seed=13), MUTANTS)):
        program.write_text(mutant)
        found, _ = certified(program, machine)
        if found is not None:
            assert found.verified_now
            taken.append(mutant)
    assert taken[0] == bare and len(taken) < MUTANTS / 3
    for text in taken:
        tip, acceleration = worst_of(text, trajectory, machine)
        assert tip <= trajectory.tolerances.tip and acceleration <= machine.strut_acceleration


@pytest.mark.slow
def test_each_part_is_certified_and_none_of_its_mutants(in_parts):
    posted, machine = in_parts
    assert len(posted.parts) > 1
    for part in posted.parts:
        text = part.read_text()
        assert certified(part, machine)[0] is not None
        for _, mutant in zip(range(10), mutants(text, seed=3), strict=False):
            part.write_text(mutant)
            assert certified(part, machine)[0] is None
        part.write_text(text)


def test_a_part_in_the_place_of_another_is_refused(in_parts, tmp_path):
    posted, machine = in_parts
    for file in posted.files:
        shutil.copy(file, tmp_path)
    first, second = (tmp_path / part.name for part in posted.parts[:2])
    shutil.copy(second, first)
    assert certified(first, machine)[0] is None


def test_uncertified_is_taken_when_that_is_said_and_logged(program, machine, caplog):
    settings, _ = pmac.settings_of(machine)
    program.write_text(re.sub(r"\d(?=:)", lambda digit: str(9 - int(digit[0])), program.read_text(), count=1))
    assert job_to_load(program, machine, settings)[0] is None
    with caplog.at_level(logging.WARNING):
        job, _ = job_to_load(program, machine, settings, uncertified=True)
    assert job is not None
    assert "UNCERTIFIED: cone.pmc, SHA-256" in caplog.text and "C109" in caplog.text


@pytest.mark.parametrize("action", ["download", "run", "stream", "step", "approach"])
def test_the_command_sends_nothing_that_is_not_certified(program, action, capsys):
    made = Controller()
    before = copy.deepcopy(made.memory.programs)
    program.write_text(next(mutants(program.read_text(), seed=5)))
    with served(made) as port:
        assert main(["pmac", action, "--port", port, "--machine", "example_6tps", str(program)]) == 1
    reported = capsys.readouterr().err
    assert "error C109" in reported and "--uncertified" in reported
    assert made.memory.programs == before


def test_the_command_loads_what_was_posted(program, machine, capsys):
    settings, _ = pmac.settings_of(machine)
    made = Controller()
    made.load(pmac.setup_text(settings, "test", machine.strut_stroke).splitlines())
    with served(made) as port:
        assert main(["pmac", "download", "--port", port, "--machine", "example_6tps", str(program)]) == 0
    assert "listed back as sent" in capsys.readouterr().out
    assert settings.program in made.memory.programs
