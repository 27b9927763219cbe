# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
import json
import math
import signal
from contextlib import contextmanager

import numpy as np
import pytest
from programs import BALL, ON_PALLET, cone, program, random_job

from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Event, EventKind, Kind, Refused, Tool
from pkm_post.options.choices import Options
from pkm_post.posting import steps
from pkm_post.posting.steps import post, step_names
from pkm_post.writing.controllers import pmac

resource = pytest.importorskip("resource")  # POSIX


@pytest.fixture(scope="module")
def machine():
    machine, faults = read_machine(find_machine("example_6tps"))
    assert not faults
    return machine


def test_everything_is_written_and_certified(machine, tmp_path):
    reported = []
    posted = post(cone(), machine, tmp_path / "cone.pmc", log=reported.append)
    names = ["cone-manifest.json", "cone-report.html", "cone-report.json", "cone-setup.pmc", "cone.pkmt", "cone.pmc"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert sorted(path.name for path in posted.files) == names
    assert posted.report == json.loads((tmp_path / "cone-report.json").read_text())
    assert posted.report["certificate"]["holds"]
    assert (tmp_path / "cone-report.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    steps = [
        "trajectory", "reach and feed plan", "collisions", "interpolation", "motion program", "certificate", "report",
    ]  # fmt: skip
    assert [line.split("  ")[0] for line in reported[:7]] == steps
    assert reported[7:] == posted.report["certificate"]["meaning"] and len(reported[7:]) == 5
    settings = pmac.PmacSettings.of(machine.controller)
    played, faults = pmac.read_program((tmp_path / "cone.pmc").read_text(), settings, "cone.pmc")
    assert not faults
    assert played.time_ms[-1] == pytest.approx(1000 * posted.report["motion"]["duration_s"])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(30))
def test_whatever_the_job_and_the_tolerances_the_certificate_holds(machine, tmp_path, seed):
    # Planner and certificate know nothing of each other's thresholds but the tolerances: none may be refused.
    rng = np.random.default_rng(seed)
    options = Options(tip_tolerance=10 ** rng.uniform(-3.5, -1), axis_tolerance=np.radians(10 ** rng.uniform(-3.5, -1)))
    posted = post(random_job(rng), machine, tmp_path / "job.pmc", options)
    assert posted.report["certificate"]["holds"]


def test_the_tolerance_that_corners_between_short_lines_need_is_named(machine, tmp_path):
    turn = np.linspace(0, np.pi, 50)  # chords of 1.28 mm, with a sagitta of 0.01 mm
    ring = program(np.column_stack([20 * np.cos(turn), 20 * np.sin(turn), 40 + 0 * turn]), feed=60.0)
    (warning,) = post(ring, machine, tmp_path / "ring.pmc").diagnostics
    assert (warning.code, str(warning.found).rpartition(";")[2]) == (
        "K160", " with a tip tolerance of 0.02 mm they become curves"
    )  # fmt: skip
    assert not post(ring, machine, tmp_path / "ring.pmc", Options(tip_tolerance=0.02)).diagnostics


def test_same_input_same_bytes(machine, tmp_path):
    for folder in ("one", "two"):
        post(cone(60, turns=0.3), machine, tmp_path / folder / "cone.pmc")
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes(), path.name


def test_the_machining_time_is_that_of_the_program(machine, tmp_path):
    made = program(
        [[0, 0, 60], [10, 0, 60], [10, 10, 60], [0, 10, 60]],
        events=(Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.DWELL, 0.75)),
    )
    posted = post(made, machine, tmp_path / "job.pmc")
    reported = posted.report["machining_time"]
    settings = pmac.PmacSettings.of(machine.controller)
    milliseconds = pmac.read_program(posted.program.read_text(), settings, "job.pmc")[0].time_ms[-1]
    (operation,) = reported["operations"]
    assert operation["name"] == "Finish"
    assert operation["cutting_s"] + operation["rapid_s"] == pytest.approx(milliseconds / 1000, abs=2e-3)
    assert operation["dwell_s"] == 0.75
    assert reported["total_s"] == pytest.approx(milliseconds / 1000 + 0.75, abs=1e-3)


@pytest.mark.slow
def test_work_offset_by_name_and_by_matrix(machine, tmp_path):
    by_name = post(cone(60, turns=0.3), machine, tmp_path / "a.pmc")
    by_matrix = post(cone(60, turns=0.3), machine, tmp_path / "b.pmc", Options(work_offset=ON_PALLET))
    one, other = (posted.program.read_text().splitlines() for posted in (by_name, by_matrix))
    # the headings name the trajectory files, in which a zero of the matrix may have a sign
    assert [line for line in one if "SHA-256" not in line] == [line for line in other if "SHA-256" not in line]


@pytest.mark.slow
def test_a_turned_work_offset_is_shown(machine, tmp_path):
    """Such as 0,0,250,5 typed for 250.5: nothing else tells the operator that the path is turned."""
    turned, turn, lines = ON_PALLET.copy(), np.radians(5.0), []
    turned[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    post(cone(60, turns=0.3), machine, tmp_path / "a.pmc", Options(work_offset=turned), log=lines.append)
    assert lines[0].endswith("segments, work offset turned by 5 degrees about z")
    post(cone(60, turns=0.3), machine, tmp_path / "b.pmc", log=lines.append)
    assert not any("turned" in line for line in lines[1:])


@contextmanager
def full_disk(size):
    """Files may not grow beyond a size: writing fails in the middle, as on a full disk."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # as Python has it; FreeCAD would be ended by it
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("size", [0, 5000, 40000])
def test_a_full_disk_leaves_nothing(machine, tmp_path, size):
    with full_disk(size), pytest.raises(Refused) as refused:
        post(cone(), machine, tmp_path / "cone.pmc")
    assert [fault.code for fault in refused.value.diagnostics] == ["F101"]
    assert "cone.pmc" in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_to(machine, tmp_path):
    (tmp_path / "taken").write_text("a file where the folder should be")
    with pytest.raises(Refused) as refused:
        post(cone(), machine, tmp_path / "taken" / "cone.pmc")
    assert [fault.code for fault in refused.value.diagnostics] == ["F101"]


def unreachable():
    return program([[0, 0, 60], [10, 0, 60], [600, 0, 60]])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "made", "options"),
    [
        ("K102", unreachable(), Options()),
        ("K108", cone(), Options(work_offset="G55")),
        ("K106", program([[0, 0, 60], [9, 0, 60]], np.array([[0, 0, 1.0], [0, 0, -1.0]])), Options()),
        ("V101", cone(60, turns=0.3), Options(tip_tolerance=1e-7, axis_tolerance=1e-7)),
    ],
)
def test_a_refused_job_leaves_nothing_and_keeps_what_was_there(machine, tmp_path, code, made, options):
    (tmp_path / "job.pmc").write_text("older program")
    with pytest.raises(Refused) as refused:
        post(made, machine, tmp_path / "job.pmc", options)
    assert code in [fault.code for fault in refused.value.diagnostics]
    assert [path.name for path in tmp_path.iterdir()] == ["job.pmc"]
    assert (tmp_path / "job.pmc").read_text() == "older program"


def test_a_machine_whose_codes_cannot_be_reported_apart(machine, tmp_path):
    codes = machine.controller["codes"] | {"coolant_flood": "M9"}
    same = dataclasses.replace(machine, controller=machine.controller | {"codes": codes})
    with pytest.raises(Refused) as refused:
        post(cone(), same, tmp_path / "job.pmc")
    assert [fault.code for fault in refused.value.diagnostics] == ["M104"]


def test_a_program_too_large_for_the_controller(machine, tmp_path):
    small = dataclasses.replace(machine, controller=machine.controller | {"memory_words": 1000})
    with pytest.raises(Refused) as refused:
        post(cone(), small, tmp_path / "job.pmc")
    assert [fault.code for fault in refused.value.diagnostics] == ["C102"]


def test_warnings_do_not_stop_the_job(machine, tmp_path):
    fast = np.array([np.nan, 30.0, 900.0])
    posted = post(program([[0, 0, 60], [10, 0, 60], [20, 0, 60]], feed=fast), machine, tmp_path / "job.pmc")
    assert [fault.code for fault in posted.diagnostics] == ["K110"]


def test_tables_of_an_earlier_result_are_reported(machine, tmp_path):
    made = cone(60, turns=0.3)
    post(made, machine, tmp_path / "cone.pmc", Options(also=("csv",)))
    (warning,) = post(made, machine, tmp_path / "cone.pmc").diagnostics
    assert warning.code == "F104" and ".csv" in warning.found


def test_a_program_of_another_suffix_beside_the_new_report_is_reported(machine, tmp_path):
    post(cone(), machine, tmp_path / "cone.ngc")
    (warning,) = post(cone(60, turns=0.3), machine, tmp_path / "cone.pmc").diagnostics
    assert (warning.code, warning.found) == ("F104", "cone.ngc")


@pytest.mark.slow
@pytest.mark.parametrize("jerk", [math.inf, 25000.0])
@pytest.mark.parametrize("lean", [0.0, 10.0])
def test_tools_of_different_lengths_are_posted(machine, tmp_path, jerk, lean):
    """The platform stands while a tool is changed; the tip of the next one begins elsewhere than the last one ended."""
    tools = {1: BALL, 2: Tool(2, "long", 8.0, 4.0, 125.0), 3: Tool(3, "short", 6.0, 3.0, 90.0)}
    events = [
        Event(0, EventKind.TOOL_CHANGE, 1),
        Event(2, EventKind.TOOL_CHANGE, 2),
        Event(5, EventKind.TOOL_CHANGE, 3),
    ]
    tip = [[0, 0, 60], [10, 0, 60], [20, 0, 60], [30, 0, 60], [30, 5, 60], [20, 5, 60], [10, 5, 70]]
    tilt = np.radians(lean) * np.arange(len(tip)) / len(tip)
    axis = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    made = program(tip, axis, events=tuple(events), tools=tools)
    posted = post(made, dataclasses.replace(machine, strut_jerk=jerk), tmp_path / "tools.pmc")
    assert posted.report["certificate"]["holds"]
    assert [tool["number"] for tool in posted.report["program"]["tools"]] == [1, 2, 3]


@pytest.mark.slow
@pytest.mark.parametrize("rise", [0.05, 0.1, 0.2, 0.25, 0.3])
def test_turns_that_rise_by_about_what_is_allowed_are_posted(machine, tmp_path, rise):
    """Both ends of such a turn are within the tolerance of each other, or nearly."""
    nowhere, start, centre = [np.nan] * 3, [0, -10, 60], [0, 0, 60]
    tip = [start, *([0, -10, 60 - rise * number] for number in (1, 2, 3))]
    kind = [Kind.RAPID, Kind.ARC, Kind.ARC, Kind.ARC]
    made = program(
        tip, kind=kind, centre=np.array([nowhere] + [centre] * 3), turn=np.array([nowhere] + [[0, 0, 1.0]] * 3)
    )
    made = dataclasses.replace(made, tip_tolerance=np.full(4, 0.1))
    assert post(made, machine, tmp_path / "ramp.pmc").report["certificate"]["holds"]


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("allowed", [0.01, 0.3])
def test_the_tip_keeps_to_the_feed_on_arcs_with_wide_tolerances(machine, tmp_path, radius, allowed):
    """Where a blend follows a line and an arc that part, the tip goes farther than the path length."""
    nowhere, centre = [np.nan] * 3, [0, 0, 60]
    tip = [[-8, -radius, 60], [0, -radius, 60], [radius, 0, 60], [radius, 8, 60]]
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.LINE]
    centres, turns = np.array([nowhere] * 4), np.array([nowhere] * 4)
    centres[2], turns[2] = centre, [0, 0, 1]
    made = program(tip, kind=kind, feed=30.0, centre=centres, turn=turns)
    made = dataclasses.replace(made, tip_tolerance=np.full(4, allowed))
    assert post(made, machine, tmp_path / "arc.pmc").report["certificate"]["holds"]


def test_a_small_arc_does_not_slow_the_way_to_it(machine, tmp_path):
    """5 mm in front of a circle of 0.1 um were run at its speed, which took 25 s."""
    nowhere = [np.nan] * 3
    centres, turns = np.array([nowhere] * 3), np.array([nowhere] * 3)
    centres[1], turns[1] = [0.00005, 0, 60], [0, 0, -1]
    made = program([[0, 0, 60], [0.0001, 0, 60], [1, 0, 60]], kind=[0, 2, 1], feed=10.0, centre=centres, turn=turns)
    assert post(made, machine, tmp_path / "small.pmc").report["motion"]["duration_s"] < 2.0


class Cancelled(Exception):  # noqa: N818 - what a window raises when its user cancels
    pass


GONE = ConnectionError("no listener")
"""What a watcher raises that is elsewhere, and what printing raises when the terminal is closed: no fault of files."""


@pytest.mark.slow
@pytest.mark.parametrize("raised", [Cancelled("enough"), GONE])
@pytest.mark.parametrize("at", [*step_names(Options(also=("csv",))), ""])
def test_what_the_progress_raises_stops_the_run_and_leaves_nothing(machine, tmp_path, at, raised):
    def stop(step, share):
        if step == at:
            raise raised

    with pytest.raises(type(raised)) as stopped:
        post(cone(60, turns=0.3), machine, tmp_path / "cone.pmc", Options(also=("csv",)), progress=stop)
    assert stopped.value is raised and list(tmp_path.iterdir()) == []


def test_what_the_log_raises_stops_the_run_and_leaves_nothing(machine, tmp_path):
    def closed(line):
        raise GONE

    with pytest.raises(ConnectionError) as stopped:
        post(cone(60, turns=0.3), machine, tmp_path / "cone.pmc", log=closed)
    assert stopped.value is GONE and list(tmp_path.iterdir()) == []


def test_a_result_that_something_else_took_away(machine, tmp_path, monkeypatch):
    """As a virus scanner does, between the moving of the files and the end."""
    move = steps.staged

    @contextmanager
    def taken(folder, *names):
        with move(folder, *names) as private:
            yield private
        (folder / "cone.pkmt").unlink()

    monkeypatch.setattr(steps, "staged", taken)
    with pytest.raises(Refused) as refused:
        post(cone(60, turns=0.3), machine, tmp_path / "cone.pmc")
    (fault,) = refused.value.diagnostics
    assert (fault.code, fault.place.file) == ("F142", str(tmp_path / "cone.pkmt"))
