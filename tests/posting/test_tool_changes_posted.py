# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs with tool changes, from the job to struts that move: posted, certified, read back, run by a simulator."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from machines import tool_change_file
from programs import TOOLS, cone, program, random_changes

sys.path.insert(0, str(Path(__file__).parents[1] / "control" / "numerical_control"))

from station import new_station  # noqa: E402

from pkm_post.cli import main  # noqa: E402
from pkm_post.control.link.program import read_job  # noqa: E402
from pkm_post.machine import (  # noqa: E402
    SpinPolicy,
    SpinRule,
    find_machine,  # noqa: E402
    strut_lengths,  # noqa: E402
)
from pkm_post.machine.description.reader import read_machine  # noqa: E402
from pkm_post.model import Event, EventKind, Kind  # noqa: E402
from pkm_post.options.choices import Options  # noqa: E402
from pkm_post.posting.steps import post  # noqa: E402
from pkm_post.writing.controllers import pmac  # noqa: E402

NANOMETRE = 1e-6
PRINTED = 0.51e-6
"""mm: half the last digit of a strut length."""
CODE = "P7003={value:d}"
"""Stands for the changer: it shows in the simulator which tool was asked for, and when."""


@pytest.fixture(scope="module")
def machine(tmp_path_factory):
    machine, faults = read_machine(tool_change_file(tmp_path_factory.mktemp("machine")))
    assert not faults
    return machine


def at_the_pose(machine):
    """(6,) strut lengths at the tool-change pose; the tool does not count, for the nose is what is stated."""
    pose, length = machine.tool_change, np.array([100.0])
    tip = machine.tool_change.tip(100.0)
    return strut_lengths(machine, tip[None], pose.axis[None], np.array([pose.spin]), length)[0]


def covered(report):
    rows = report["certificate"]["coverage"]
    return {row["what"]: row["extent"] for row in rows if row["topic"] == "approach, tool change, spindle"}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(16))
def test_whatever_the_tools_the_certificate_holds_and_the_struts_are_at_the_pose(machine, tmp_path, seed):
    rng = np.random.default_rng(seed)
    rule = [SpinRule.ZERO, SpinRule.FILE, SpinRule.X_IN_PLANE, SpinRule.OPTIMISED][seed % 4]
    posted = post(random_changes(rng), machine, tmp_path / "job.pmc", Options(spin=SpinPolicy(rule)))
    assert posted.report["certificate"]["holds"]
    assert covered(posted.report) == {
        "way to the start of the program": "not covered",
        "approach from the start to the first point": "proven",
        "tool change": "proven",
        "spindle speed at the first cut": "proven",
    }
    played, _ = pmac.read_program(posted.program.read_text(), pmac.PmacSettings.of(machine.controller), "job.pmc")
    rows = [event.row for event in played.events if event.kind is EventKind.TOOL_CHANGE]
    assert rows
    expected = np.tile(at_the_pose(machine), (len(rows), 1))
    np.testing.assert_allclose(played.length[rows], expected, atol=PRINTED)
    assert not played.speed[rows].any()


def test_without_a_pose_nothing_is_added_and_nothing_is_covered(tmp_path):
    machine, _ = read_machine(find_machine("example_6tps"))
    posted = post(random_changes(np.random.default_rng(1)), machine, tmp_path / "job.pmc")
    assert posted.report["program"]["operations"] == ["Finish"]
    extents = covered(posted.report)
    assert extents["tool change"] == extents["spindle speed at the first cut"] == "not covered"


def test_the_report_tells_the_times_of_tool_changes(machine, tmp_path):
    events = (
        Event(0, EventKind.TOOL_CHANGE, 1),
        Event(2, EventKind.TOOL_CHANGE, 2),
        Event(2, EventKind.SPINDLE, 12000.0),
    )
    posted = post(
        program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], events=events, tools=TOOLS), machine, tmp_path / "a.pmc"
    )
    assert posted.report["program"]["operations"] == ["Finish", "tool change T1", "tool change T2"]
    times = {operation["name"]: operation for operation in posted.report["machining_time"]["operations"]}
    assert times["tool change T2"]["rapid_s"] > 0.5 and times["tool change T2"]["cutting_s"] == 0.0
    assert times["tool change T2"]["dwell_s"] == 1.0  # 12000 of 24000 rpm in half of 2 s, at the pose


def test_the_heading_names_the_pose_that_the_program_starts_from(tmp_path):
    machine, _ = read_machine(find_machine("example_6tps"))
    leaning = replace(machine, home_axis=np.array([0.06, 0.0, np.sqrt(1 - 0.0036)]), home_spin=np.radians(2.5))
    text = post(cone(9, turns=0.02), leaning, tmp_path / "a.pmc").program.read_text()
    assert (
        "; start of the program, at rest: tip of T1 at X0 Y0 Z300, axis I0.06 J0 K0.998198, spin 2.5 degrees,"
        " in the machine frame\n"
    ) in text


def three_tools():
    """Cuts with three tools; the tool is tilted where two of them change, and the last one changes at the end.

    At each change the spindle starts, and is waited for at the pose.
    """
    tilt = np.radians([0.0, 5, 12, 12, 0, -9])
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    position = [[0, 0, 60], [15, 0, 60], [20, 5, 58], [-20, 5, 62], [-10, 0, 55], [0, 0, 62]]
    kind = [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID, Kind.LINE, Kind.LINE]
    changes = [Event(row, EventKind.TOOL_CHANGE, float(tool)) for row, tool in ((0, 1), (2, 2), (3, 3), (6, 1))]
    events = [both for change in changes for both in (change, Event(change.row, EventKind.SPINDLE, 6000.0))]
    return program(position, axis, kind=kind, events=tuple(events), tools=TOOLS, feed=100.0)


@pytest.mark.slow
def test_the_simulated_controller_stands_at_the_pose_whenever_a_tool_is_asked_for(machine, tmp_path):
    codes = machine.controller["codes"] | {"tool_change": CODE}
    settings = pmac.PmacSettings.of(machine.controller | {"codes": codes})
    posted = post(three_tools(), machine, tmp_path / "job.pmc")
    played, _ = pmac.read_program(posted.program.read_text(), pmac.PmacSettings.of(machine.controller), "job.pmc")
    job, faults = read_job(pmac.program_text(played, settings, ["job"]), settings, "job.pmc")
    assert not faults
    station = new_station()
    station.control.load(job, lambda done, lines: None, lambda: False)
    station.control.start(job)
    asked, lengths = [0.0], []
    for _ in range(60_000):
        station.wire.controller.advance(1)
        tool = station.wire.controller.variables.read("P", 7003)
        if tool != asked[-1]:
            asked.append(tool)
            station.wire.controller.advance(1)  # the motors follow what was calculated; the spindle is waited for
            lengths.append(station.motors.commanded / settings.counts_per_mm + settings.zero_length)
        if not station.wire.controller.runs_program():
            break
    assert asked[1:] == [1, 2, 3, 1]
    count = 1.0 / settings.counts_per_mm  # the simulated motors go by whole counts
    np.testing.assert_allclose(lengths, np.tile(at_the_pose(machine), (4, 1)), atol=count)


@pytest.mark.slow
def test_from_a_file_by_the_command_line_and_verified_again(tmp_path, capsys):
    made = tool_change_file(tmp_path)
    assert main(["machine", "check", str(made)]) == 0
    reported = capsys.readouterr()
    assert "spindle nose at (90, -60, 460) mm, tips free from z 270 mm upwards" in reported.out
    assert "diameter up to 40 mm" in reported.out and "2 s to the highest speed, 3 s to rest" in reported.out
    assert reported.err == ""
    source = tmp_path / "two.ngc"
    source.write_text(
        "G21 G90 G94\nT1 M6\nS6000 M3\nG0 X0 Y0 Z60\nG1 Z50 F600\nG1 X20\nG0 Z60\nT2 M6\nS8000 M3\nG0 X-20\nG1 Z52\n"
        "G1 Y9\nM5\nM2\n"
    )
    tools = ["--tool-length", "1=120", "--tool-length", "2=95", "--tool", "1=10", "--tool", "2=6"]
    command = ["post", str(source), "--machine", str(made), *tools, "--also", "linuxcnc,csv,halstreamer"]
    assert main([*command, "--out", str(tmp_path)]) == 0
    report = json.loads((tmp_path / "two-report.json").read_text())
    assert report["program"]["operations"][1:] == ["tool change T1", "tool change T2"]
    program, against = (str(tmp_path / f"two.{suffix}") for suffix in ("pmc", "pkmt"))
    assert main(["verify", program, "--against", against, "--machine", str(made)]) == 0
    capsys.readouterr()
    assert main(["post", str(source), "--machine", str(made), "--tool-length", "1=190", *tools[2:]]) == 1
    assert "tool change T1: line 4: error K140" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "code", "found"),
    [
        ("safe_height = 270.0", "", "M103", "needed with tool_change.nose"),
        ("nose = [90.0, -60.0, 460.0]", "", "M103", "needed with tool_change.safe_height"),
        ("safe_height = 270.0", "safe_height = 460.0", "M106", "is not below the spindle nose"),
        ("spin_up_time = 2.0", "", "M103", "needed with spindle.spin_down_time"),
        ("spin_up_time = 2.0", "spin_up_time = 0", "M104", "expected a number above 0"),
        ("axis = [0.1, 0.06, 1.0]", "axis = [0.1, 0.06, -1.0]", "M104", "the third above 0"),
        ("nose = [90.0, -60.0, 460.0]\naxis = [0.1, 0.06, 1.0]", "nose = [0.0, 0.0, 460.0]", "M106", "home_spin"),
    ],
)
def test_what_a_machine_file_may_not_say_of_it(tmp_path, old, new, code, found):
    made = tool_change_file(tmp_path)
    text = made.read_text()
    assert text.count(old) == 1
    made.write_text(text.replace(old, new))
    machine, faults = read_machine(made)
    assert machine is None
    assert [fault.code for fault in faults] == [code]
    assert found in str(faults[0])


@pytest.mark.parametrize(
    ("old", "new"),
    [("nose = [90.0,", "nose = [690.0,"), ("axis = [0.1, 0.06, 1.0]", "axis = [1.5, 0.0, 1.0]"), ("7.0", "75.0")],
)
def test_a_pose_out_of_reach_is_reported(tmp_path, capsys, old, new):
    made = tool_change_file(tmp_path)
    table = made.read_text().partition("[tool_change]")
    made.write_text(table[0] + table[1] + table[2].replace(old, new, 1))
    assert main(["machine", "check", str(made)]) == 0
    reported = capsys.readouterr().err
    assert "M115" in reported and "M108" not in reported
