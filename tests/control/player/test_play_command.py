# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``pmac play`` with a simulated controller that serves: a posted trajectory, orders, a line."""

import copy
import io
import shutil
import threading
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from meshes import binary_stl, box
from playing import LONGEST_S, TOOL
from rig import served
from station import MACHINE, SETTINGS, set_up

from pkm_post.cli import main
from pkm_post.cli.pmac_play import _Shown, order_of
from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.player.approach_check import check_start
from pkm_post.control.player.playable import first_row, read_playable
from pkm_post.control.player.stop_events import PlayContext
from pkm_post.machine import forward_along_path, strut_lengths
from pkm_post.model import Event, EventKind
from pkm_post.posting.post_file import post_file
from pkm_post.toolpath import ToolPose

SOURCE = "G21 G90 G54\nG0 X0 Y0 Z100\nS1000 M3\nG1 X20 F6000\nG1 Y10\nM30\n"
NAME = "example_6tps"


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("posted")
    (folder / "part.ngc").write_text(SOURCE)
    post_file(folder / "part.ngc", NAME, folder, tool_lengths={0: TOOL})
    return folder / "part.pkmt"


def play(port, file, *arguments):
    return main(["pmac", "play", str(file), "--port", port, "--machine", NAME, "--patience", "10", *arguments])


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["tcp", "serial"])
def test_a_trajectory_is_played_over_a_link(kind, posted, capsys, monkeypatch):
    made = copy.deepcopy(set_up())
    monkeypatch.setattr("sys.stdin", io.StringIO("override 140\nfaster\n"))
    with served(made, kind) as port:
        assert play(port, posted, *(["--from-line", "5"] if kind == "serial" else [])) == (kind == "serial")
        shown = capsys.readouterr()
        if kind == "serial":  # no one has said that the tool is in the spindle
            assert (
                "waits: T0, 120 mm long, in the spindle, line 5" in shown.out and "ended by the operator" in shown.out
            )
            return
        assert "the program has ended" in shown.out and "deviation of the tool tip: 0.000" in shown.out
        assert "expected one of override PERCENT" in shown.err
    assert made.systems[0].path.abrupt_stops == 0 and not made.runs_program()
    assert made.variables.read("P", 7001) == 0  # M30 has stopped the spindle


@pytest.fixture
def starts_where_it_waits(monkeypatch):
    """A standard input that orders a start when the player waits for one, and is open until the test ends."""
    waits, ended, show = threading.Event(), threading.Event(), _Shown.show

    def shown(self, state):
        show(self, state)
        if state.waits_for:
            waits.set()

    def lines():
        if waits.wait(LONGEST_S):
            yield "start\n"
        ended.wait(LONGEST_S)

    monkeypatch.setattr(_Shown, "show", shown)
    monkeypatch.setattr("sys.stdin", lines())
    yield
    ended.set()


@pytest.mark.slow
def test_a_work_offset_and_a_tool_that_were_changed_at_the_machine(posted, capsys, starts_where_it_waits):
    made = copy.deepcopy(set_up())
    with served(made, "tcp") as port:
        choices = "--approach", "--shift=1,-2,3", "--tool-length", f"0={TOOL + 4}"
        assert play(port, posted, *choices) == 0, capsys.readouterr()
    assert "T0, 124 mm long, in the spindle" in capsys.readouterr().out
    struts = made.motors.commanded[None, :6] / SETTINGS.counts_per_mm + np.array(SETTINGS.zero_length)
    found = forward_along_path(MACHINE, struts, np.array([TOOL + 4]), ToolPose.at_home(MACHINE))
    end = read_playable(posted, MACHINE)[0].tip[-1]
    np.testing.assert_allclose(found.tip[0], end + [1, -2, 3], atol=1e-3)


@pytest.mark.parametrize(
    ("given", "lacks"),
    [
        (["--block-skip"], "--skipped"),
        (["--operation", "Profile"], "--from-line"),
        (["--repeat-codes"], "--from-line"),
    ],
)
def test_options_that_would_do_nothing_are_refused(posted, capsys, given, lacks):
    """An operator who skips blocks, and has no posting without them, would see them run."""
    made = copy.deepcopy(set_up())
    with served(made, "tcp") as port:
        assert play(port, posted, *given) == 2
    assert f"{given[0]}: error U102: an argument is missing: {lacks}" in capsys.readouterr().err
    assert not made.runs_program()


def test_an_order_to_skip_blocks_without_a_posting_without_them_is_answered(monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.StringIO("skip on\nskip off\n"))
    shown, orders = _Shown(lambda: 0.0, skips=False), []
    shown.player = SimpleNamespace(order=orders.append)
    shown._read()
    assert "no block can be skipped without --skipped" in capsys.readouterr().err
    assert [(order.kind, order.value) for order in orders] == [("skip", 0.0)]


def test_a_clamp_on_the_way_to_a_line(posted, tmp_path, capsys, starts_where_it_waits):
    clamp = tmp_path / "clamp.stl"
    clamp.write_bytes(binary_stl(box([15, -5, 60], [25, 5, 200])))
    made = copy.deepcopy(set_up())
    with served(made, "tcp") as port:
        assert play(port, posted, "--from-line", "5", "--fixture", str(clamp)) == 1
    assert "K133" in capsys.readouterr().err and made.systems[0].path.abrupt_stops == 0


@pytest.mark.slow
@pytest.mark.parametrize(("top", "length", "code"), [(164.0, 120.0, 0), (164.0, 100.0, 1), (140.0, 100.0, 0)])
def test_a_shorter_tool_whose_holder_meets_the_part_is_not_played(
    posted, tmp_path, capsys, starts_where_it_waits, top, length, code
):
    (tmp_path / "part.stl").write_bytes(binary_stl(box([30, -20, 0], [40, 20, top])))
    made = copy.deepcopy(set_up())
    with served(made, "tcp") as port:
        offsets = "--approach", "--tool-length", f"0={length}"
        assert play(port, posted, "--part", str(tmp_path / "part.stl"), *offsets) == code
    reported = capsys.readouterr().err
    assert ("K117" in reported) == bool(code) and made.systems[0].path.abrupt_stops == 0, reported


def approach(port, folder, *arguments):
    order = [str(folder / "part.pmc"), "--port", port, "--machine", NAME, *arguments]
    return main(["pmac", "approach", *order])


@pytest.mark.slow
def test_a_clamp_on_the_way_to_the_start_of_a_program(posted, tmp_path, capsys):
    clamp, made = tmp_path / "clamp.stl", copy.deepcopy(set_up())
    start = read_playable(posted, MACHINE)[0].start_tip - [0, 0, MACHINE.work_offsets["G54"][2, 3]]
    clamp.write_bytes(binary_stl(box(start + [15, -5, -10], start + [25, 5, 200])))
    with served(made, "tcp") as port:
        assert main(["pmac", "jog", "--x", "40", "--port", port, "--machine", NAME, "--feed", "3000"]) == 0
        away = made.motors.commanded.copy()
        assert approach(port, posted.parent, "--fixture", str(clamp)) == 1
        assert "K133" in capsys.readouterr().err and (made.motors.commanded == away).all()
        assert approach(port, posted.parent, "--fixture", str(tmp_path / "none.stl")) == 1
        assert approach(port, posted.parent, "--trajectory", str(posted), "--tool-length", "90") == 1
        assert "a tool of 120 mm, not of 90 mm" in capsys.readouterr().err
        clamp.write_bytes(binary_stl(box(start + [15, 60, -10], start + [25, 70, 40])))
        assert approach(port, posted.parent, "--fixture", str(clamp), "--feed", "3000") == 0


def test_a_trajectory_that_begins_elsewhere_than_the_program_says_nothing_of_the_way_to_it(posted):
    made = read_playable(posted, MACHINE)[0]
    task = PlayContext(None, MACHINE, SETTINGS, made)
    pose = made.start_tip[None], made.start_axis[None], np.array([made.start_spin]), np.array([TOOL])
    first = strut_lengths(MACHINE, *pose)[0]
    check_start(task, first, TOOL)
    with pytest.raises(NotReadyError, match="elsewhere than the program: a strut is 0.100 mm off"):
        check_start(task, first + [0, 0, 0.1, 0, 0, 0], None)


def test_the_command_play_is_that_of_pmac(posted, capsys):
    order = [str(posted), "--port", "tcp:127.0.0.1:1", "--machine", NAME]
    assert main(["play", *order]) == main(["pmac", "play", *order]) == 1
    assert capsys.readouterr().err.count("127.0.0.1, port 1") == 2


def test_what_cannot_be_played_is_refused(posted, tmp_path):
    trajectory, tolerances, faults = read_playable(posted, MACHINE)
    assert not faults and tolerances == trajectory.tolerances
    assert first_row(trajectory, 5, "", posted)[0] == len(trajectory) - 1
    with_clamp = replace(trajectory, events=(*trajectory.events, Event(1, EventKind.FUNCTION, 21.0)))
    row, faults = first_row(with_clamp, 5, "", posted)
    assert row == len(trajectory) - 1 and [(each.code, each.found) for each in faults] == [("K152", "M21")]
    assert first_row(with_clamp, 5, "", posted, repeat_codes=True) == (len(trajectory) - 1, ())
    row, faults = first_row(trajectory, 99, "", posted)
    assert row is None and [each.code for each in faults] == ["C207"]
    _, _, faults = read_playable(posted, replace(MACHINE, tip_jerk=1e5))
    assert not faults
    _, _, faults = read_playable(posted, replace(MACHINE, fingerprint="0" * 64))
    assert [each.code for each in faults] == ["T104"]


def test_a_trajectory_of_another_posting_than_the_manifest_is_not_played(posted, tmp_path, capsys):
    """Its collisions were never looked for: those of the posting are of another program."""
    for file in posted.parent.glob("part*"):
        shutil.copy(file, tmp_path)
    (tmp_path / "other.ngc").write_text(SOURCE.replace("Y10", "Y15"))
    post_file(tmp_path / "other.ngc", NAME, tmp_path, tool_lengths={0: TOOL})
    alone = shutil.copy(tmp_path / "other.pkmt", tmp_path / "alone.pkmt")
    shutil.copy(alone, tmp_path / "part.pkmt")
    trajectory, _, faults = read_playable(tmp_path / "part.pkmt", MACHINE)
    assert trajectory is None and [(each.code, each.found) for each in faults] == [("F106", "part.pkmt has changed")]
    trajectory, _, faults = read_playable(tmp_path / "alone.pkmt", MACHINE)
    assert trajectory is not None and [each.code for each in faults] == ["F107"]


def test_orders_of_an_operator():
    assert order_of("Override 120\n") == ("override", 1.2)
    assert order_of("single on") == ("single", 1.0)
    assert order_of("optional off") == ("optional", 0.0)
    assert order_of("end\n") == ("end", 0.0)
    assert order_of("retract 12.5") == ("retract", 12.5)
    for line in (
        "retract",
        "retract -1",
        "retract 1e9",
        "override 151",
        "override -1",
        "override",
        "single",
        "optional",
        "hold now",
        "",
        "stop",
    ):
        assert order_of(line) is None
