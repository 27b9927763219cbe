# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small job posted for each kind of controller: the certificate holds, and ``verify`` says so again."""

import argparse
import dataclasses
import re

import pytest
from programs import cone
from verified_reports import agree

from pkm_post.machine import machine_named
from pkm_post.model import Event, EventKind, Refused
from pkm_post.options import add_options, options_from
from pkm_post.options.choices import LINUXCNC, Options
from pkm_post.posting.steps import SUFFIX, post
from pkm_post.posting.verify import verify
from pkm_post.writing.controllers import CONTROLLERS, TABLES
from pkm_post.writing.controllers.halstreamer import chord_error
from pkm_post.writing.controllers.motion_csv import read_table


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def job():
    """Stops on the way, so that there are rests where a program can be cut."""
    stops = (Event(8, EventKind.STOP, 0.0), Event(16, EventKind.DWELL, 0.2), Event(20, EventKind.SPINDLE, 900.0))
    return dataclasses.replace(cone(24, turns=0.2), events=(Event(0, EventKind.TOOL_CHANGE, 1), *stops))


def of_kind(machine, kind, **changes):
    return dataclasses.replace(machine, controller=machine.controller | {"kind": kind} | changes)


@pytest.mark.slow
@pytest.mark.parametrize("kind", CONTROLLERS)
def test_a_job_is_posted_and_verified_for_every_kind(machine, tmp_path, kind):
    other, controller = of_kind(machine, kind), CONTROLLERS[kind]
    posted = post(job(), other, tmp_path / f"job{SUFFIX}")
    assert posted.report["certificate"]["holds"]
    assert f"job{controller.SETUP_SUFFIX}" in {path.name for path in posted.files}
    _, report, warnings = verify(posted.program, posted.program.with_suffix(".pkmt"), other)
    assert not warnings
    agree(report, posted.report)


@pytest.mark.slow
@pytest.mark.parametrize("kind", CONTROLLERS)
def test_codes_as_synchronous_assignments_are_certified(machine, tmp_path, kind):
    codes = machine.controller["codes"] | {
        "spindle_clockwise": "M70=={value} DWELL0",
        "spindle_stop": "M71==0 DWELL0",
        "coolant_flood": "M60==1 DWELL0",
        "coolant_off": "M60==0 DWELL0",
    }
    posted = post(job(), of_kind(machine, kind, codes=codes), tmp_path / "job.pmc")
    assert posted.report["certificate"]["holds"]
    assert "\nM70==900 DWELL0\n" in posted.program.read_text()


@pytest.fixture(scope="module")
def in_parts(machine, tmp_path_factory):
    small = of_kind(machine, "turbo_pmac", memory_words=1000)
    return small, post(job(), small, tmp_path_factory.mktemp("parts") / "job.pmc")


@pytest.mark.slow
def test_a_program_larger_than_the_memory_is_certified_in_parts(machine, in_parts, tmp_path):
    _, posted = in_parts
    whole = post(job(), machine, tmp_path / "job.pmc")
    parts = sorted(path.name for path in posted.files if path.name.endswith(".pmc") and "setup" not in path.name)
    count = len(parts)
    assert count > 1
    assert parts == sorted(["job.pmc", *(f"job-part{number}.pmc" for number in range(2, count + 1))])
    assert len(posted.report["files"]["programs_sha256"]) == count
    assert posted.report | {"files": None} == whole.report | {"files": None}
    moves = [re.findall(r"^A.*:.*$", path.read_text(), re.MULTILINE) for path in posted.files if path.name in parts]
    assert sum(map(len, moves)) == len(re.findall(r"^A.*:.*$", whole.program.read_text(), re.MULTILINE))


def test_a_program_in_parts_is_verified_from_its_first(in_parts):
    small, posted = in_parts
    _, report, warnings = verify(posted.program, posted.program.with_suffix(".pkmt"), small)
    assert not warnings
    agree(report, posted.report)


def test_a_part_that_is_missing_or_another_is_found(in_parts, tmp_path):
    small, posted = in_parts
    for path in posted.files:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    first, second = tmp_path / "job.pmc", tmp_path / "job-part2.pmc"
    trajectory = tmp_path / "job.pkmt"
    for spoil, code in (
        (lambda: second.write_text(second.read_text().replace("A1", "A2", 1)), "C105"),
        (lambda: second.write_bytes(first.read_bytes()), "C105"),
        (second.unlink, "F103"),
    ):
        spoil()
        with pytest.raises(Refused) as refused:
            verify(first, trajectory, small)
        assert code in [fault.code for fault in refused.value.diagnostics]


def test_a_later_part_alone_is_not_the_program(in_parts):
    small, posted = in_parts
    with pytest.raises(Refused) as refused:
        verify(posted.program.with_name("job-part2.pmc"), posted.program.with_suffix(".pkmt"), small)
    assert "C105" in [fault.code for fault in refused.value.diagnostics]


def test_tables_are_written_beside_the_program(machine, tmp_path):
    reported = []
    posted = post(job(), machine, tmp_path / "job.pmc", Options(also=tuple(TABLES)), log=reported.append)
    names = {path.name for path in posted.files}
    assert {"job.csv", "job-halstreamer.txt", "job-halstreamer-part2.txt", "job-halstreamer-part3.txt"} <= names
    motion, faults = read_table((tmp_path / "job.csv").read_text(), "job.csv")
    assert not faults
    assert motion.time_ms[-1] == pytest.approx(1000 * posted.report["motion"]["duration_s"])
    assert [line.split("  ")[0] for line in reported[-2:]] == ["also csv", "also halstreamer"]
    first = (tmp_path / "job-halstreamer.txt").read_text()
    assert f"at most {chord_error(motion):.3g} mm" in first
    assert "# before: tool_change 1\n" in first


def test_the_tables_do_not_speak_of_the_program(machine, tmp_path):
    post(job(), machine, tmp_path / "job.pmc", Options(also=("halstreamer",)))
    assert "# machine Example 6-TPS" in (tmp_path / "job-halstreamer.txt").read_text()
    assert "certified" not in (tmp_path / "job-halstreamer.txt").read_text()


def test_the_command_line_knows_all_that_can_be_written():
    parser = argparse.ArgumentParser()
    add_options(parser)
    every = (*TABLES, LINUXCNC)
    assert options_from(parser.parse_args(["--also", ",".join(reversed(every))])).also == every
    assert options_from(parser.parse_args([])).also == ()
    with pytest.raises(SystemExit):
        parser.parse_args(["--also", "csv,excel"])


def test_a_name_that_is_not_known_is_refused_before_anything_is_done():
    with pytest.raises(
        ValueError, match="also: expected names out of csv, halstreamer, linuxcnc, picture, cartesian, got csv, excel"
    ):
        Options(also=("csv", "excel"))


@pytest.mark.slow
def test_the_same_job_gives_the_same_tables(machine, tmp_path):
    for folder in ("one", "two"):
        post(job(), machine, tmp_path / folder / "job.pmc", Options(also=tuple(TABLES)))
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes(), path.name
