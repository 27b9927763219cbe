# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``pmac home``, ``jog``, ``mdi``, ``step``, ``continue``, ``override`` with a simulated controller."""

import copy
import io
import os
import re
import select
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from rig import served
from station import MACHINE as EXAMPLE
from station import PER_BLOCK, SETTINGS, TOOL, job, set_up

from pkm_post.cli import main, pmac_manual
from pkm_post.cli.pmac_manual import print_emergency_steps
from pkm_post.control.simulator import Controller
from pkm_post.model import Event, EventKind
from pkm_post.posting.post_file import post_file
from pkm_post.writing.controllers.pmac import program_text, setup_text

MACHINE = "example_6tps"
LONGEST_S = 240.0
FAST = 5.0
"""Simulated seconds in a second, as far as this computer keeps up."""
START = 1007.8869
"""mm: the struts of the example at home."""


@pytest.fixture
def simulator():
    """A controller that serves in a thread, and the name of its port."""
    made = copy.deepcopy(set_up())
    with served(made, speed=FAST) as port:
        yield made, port


def pmac(action, port, *arguments):
    is_by_hand = action != "step" and any(isinstance(argument, Path) for argument in arguments)
    by_hand = ["--uncertified"] if is_by_hand else []
    named = ["--machine", MACHINE, "--patience", "10", *by_hand]
    return main(["pmac", action, "--port", port, *named, *map(str, arguments)])


def tip(reported):
    return [float(number) for number in re.search(r"tip X(\S+) Y(\S+) Z(\S+) mm", reported).groups()]


@pytest.mark.slow
def test_jogs_and_lines(simulator, capsys):
    made, port = simulator
    assert pmac("jog", port, "--x", 3, "--z", "-2", "--feed", 3000) == 0
    reported = capsys.readouterr().out
    assert (
        np.allclose(tip(reported), [3, 0, 298], atol=2e-3) and "arrived; no strut is off by more than 0.000" in reported
    )
    assert pmac("mdi", port, "G91 G1 Y4 F3000") == 0
    assert np.allclose(tip(capsys.readouterr().out), [3, 4, 298], atol=2e-3)
    assert pmac("jog", port, "--strut", 2, "--by", 1.5, "--feed", 3000, "--number", 77) == 0
    assert 77 in made.memory.programs and not made.runs_program()
    capsys.readouterr()
    assert pmac("monitor", port, "--seconds", 0.1) == 0
    assert "spin" in capsys.readouterr().out


@pytest.mark.slow
def test_codes_that_another_client_aborts_have_not_been_carried_out(simulator, capsys, monkeypatch):
    """They do not move the tool, so the place where it rests does not tell."""
    _, port = simulator
    assert pmac("mdi", port, "G4 P0.1 M8") == 0
    waits, aborted = pmac_manual.wait_for_end, []

    def aborted_meanwhile(control, seconds):
        aborted.append(pmac("abort", port))
        return waits(control, seconds)

    monkeypatch.setattr(pmac_manual, "wait_for_end", aborted_meanwhile)
    capsys.readouterr()
    assert pmac("mdi", port, "G4 P600") == 1 and aborted == [0]
    reported = capsys.readouterr()
    assert "ended from elsewhere" in reported.err and "arrived" not in reported.out


def test_nothing_is_sent_that_is_refused_or_only_checked(simulator, capsys):
    made, port = simulator
    assert pmac("jog", port, "--x", 900) == 1
    assert "K102" in capsys.readouterr().err
    assert pmac("mdi", port, "G1 X10") == 1
    assert "C225" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        pmac("mdi", port, "G1 X1 F100\nG1 X2")
    assert "error U103: an argument is not valid: LINE: expected one line, got" in capsys.readouterr().err
    for words, found in (
        (("--strut", 2, "--by", 1, "--z", 5, "--tilt-x", 1), "either --strut or --z, --tilt-x"),
        (("--x", 1, "--by", 5), "--strut and --by together"),
        (("--strut", 2), "--strut and --by together"),
    ):
        assert pmac("jog", port, *words) == 2
        reported = capsys.readouterr().err
        assert "pmac jog: error U103" in reported and f"expected {found}" in reported
    assert pmac("jog", port, "--tilt-x", 3, "--check") == 0
    assert "3.000 deg from upright" in capsys.readouterr().out
    assert pmac("jog", port, "--x", 1, "--number", SETTINGS.program) == 1
    assert "choose another --number" in capsys.readouterr().err
    assert 999 not in made.memory.programs


def test_without_homes_no_tool_is_at_the_start_of_a_program(capsys, tmp_path):
    """The law of moves by hand: all struts homed. The counters of this one happen to show the lengths of the start."""
    made, file = Controller(), tmp_path / "job.pmc"
    made.load(setup_text(SETTINGS, "test", EXAMPLE.strut_stroke).splitlines())
    file.write_text(program_text(job(SETTINGS, ()).motion, SETTINGS, ["job"]))
    with served(made, speed=FAST) as port:
        assert pmac("approach", port, file) == 1
    reported = capsys.readouterr()
    assert "strut 6: not homed" in reported.err and "at the start" not in reported.out


@pytest.mark.slow
def test_the_way_to_the_start_of_a_program(simulator, capsys, tmp_path):
    made, port = simulator
    file = tmp_path / "job.pmc"
    file.write_text(program_text(job(SETTINGS, ()).motion, SETTINGS, ["job"]))
    assert pmac("approach", port, file) == 0
    assert "the tool is at the start of the program" in capsys.readouterr().out
    assert pmac("download", port, file) == 0
    assert pmac("jog", port, "--x", 4, "--tilt-y", 1, "--feed", 3000) == 0
    capsys.readouterr()
    assert pmac("run", port, file) == 1
    assert "away from the start of the program: tip 4.000 mm, axis 1.0000 degrees" in capsys.readouterr().err
    assert pmac("approach", port, file, "--check") == 0
    assert pmac("run", port, file) == 1
    assert pmac("approach", port, file, "--feed", 3000) == 0
    assert "arrived" in capsys.readouterr().out
    assert pmac("run", port, file, "--no-watch") == 0
    until_it_rests(made)


def test_home(simulator, capsys):
    made, port = simulator
    assert pmac("home", port) == 0
    assert "all struts are homed" in capsys.readouterr().out
    made.motors.homed[2] = False
    assert pmac("home", port) == 1
    assert "not homed: strut 3" in capsys.readouterr().out
    assert pmac("home", port, "--trigger", "#3HM") == 0
    assert "all struts have found their homes" in capsys.readouterr().out


def test_override(simulator, capsys):
    _, port = simulator
    assert pmac("override", port, 40) == 0
    assert "override 40 %" in capsys.readouterr().out


LINES = ("G1 X2 Y0 Z300 F3000", "X2 Y1", "X0 Y0")


@pytest.mark.slow
def test_line_by_line(simulator, capsys, monkeypatch, tmp_path):
    made, port = simulator
    source = tmp_path / "part.ngc"
    source.write_text("G21 G90 G54\n" + "\n".join(LINES) + "\nM30\n")
    post_file(source, MACHINE, tmp_path, tool_lengths={0: TOOL})
    file = tmp_path / "part.pmc"
    monkeypatch.setattr("sys.stdin", io.StringIO("\n\n\n"))
    assert pmac("step", port, file) == 0
    reported = capsys.readouterr().out
    begun = [line for line in reported.splitlines() if line.startswith("block")]
    assert begun == [
        f"block {number} of 3, line {number + 1}: {line}; Enter starts it, the end of the input ends here"
        for number, line in enumerate(LINES, 1)
    ]
    assert reported.count("arrived; no strut is off by more than 0.000") == 3 and reported.endswith(
        "the program has ended\n"
    )
    assert pmac("approach", port, file, "--feed", 6000) == 0
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    assert pmac("step", port, file) == 0
    reported = capsys.readouterr().out
    assert "the program has ended" not in reported and "block 2 of 3, line 3" in reported
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    assert pmac("step", port, file, "--block", 2) == 0
    assert "block 3 of 3, line 4" in capsys.readouterr().out
    assert pmac("step", port, file, "--block", 4) == 1
    assert "there is no block 4: the program has 3" in capsys.readouterr().err
    (tmp_path / "part-manifest.json").unlink()
    assert pmac("step", port, file) == 1
    assert "C205" in capsys.readouterr().err and not made.runs_program()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="has no pseudo terminals")
def test_enter_pressed_twice_starts_one_line(simulator, capsys, monkeypatch, tmp_path):
    _, port = simulator
    source = tmp_path / "part.ngc"
    source.write_text("G21 G90 G54\n" + "\n".join(LINES) + "\nM30\n")
    post_file(source, MACHINE, tmp_path, tool_lengths={0: TOOL})
    keyboard, terminal = os.openpty()

    def readline():
        if not asked:
            os.write(keyboard, b"\n\n")
        asked.append(True)
        is_typed = select.select([terminal], [], [], 0)[0]
        return os.read(terminal, 1).decode() if is_typed else ""

    asked = []
    monkeypatch.setattr("sys.stdin", SimpleNamespace(isatty=lambda: True, fileno=lambda: terminal, readline=readline))
    assert pmac("step", port, tmp_path / "part.pmc") == 0
    reported = capsys.readouterr().out
    assert reported.count("arrived") == 1 and "block 2 of 3" in reported
    os.close(keyboard)
    os.close(terminal)


def test_behind_a_stop(simulator, capsys, tmp_path):
    made, port = simulator
    motion = job(SETTINGS, (Event(PER_BLOCK, EventKind.STOP, 0.0),)).motion
    file = tmp_path / "job.pmc"
    file.write_text(program_text(motion, SETTINGS, ["job"]))
    assert pmac("download", port, file) == 0 and pmac("run", port, file, "--no-watch") == 0
    until_it_rests(made)
    assert pmac("resume", port) == 1
    assert "no program is held; after a stop (M0, M1) continue it" in capsys.readouterr().err
    assert pmac("continue", port, file, "--stop", 2) == 1
    assert "there is no stop 2" in capsys.readouterr().err
    assert pmac("continue", port, file, "--stop", 1, "--no-watch") == 0
    assert "a program runs" in capsys.readouterr().out
    until_it_rests(made)
    commanded = made.motors.commanded / SETTINGS.counts_per_mm + SETTINGS.zero_length
    assert np.allclose(commanded, motion.length[-1], atol=1e-4)


@pytest.mark.slow
def test_a_program_is_watched_to_its_end_to_a_stop_and_for_its_override(simulator, tmp_path, capsys):
    made, port = simulator
    file = tmp_path / "job.pmc"
    file.write_text(program_text(job(SETTINGS, (Event(PER_BLOCK, EventKind.STOP, 0.0),)).motion, SETTINGS, ["job"]))
    assert pmac("download", port, file) == 0 and pmac("run", port, file) == 0
    assert "no program runs" in capsys.readouterr().out and not made.runs_program()
    assert pmac("continue", port, file, "--stop", 1) == 0
    assert "no program runs" in capsys.readouterr().out and not made.runs_program()
    slow = tmp_path / "slow.pmc"
    motion = job(SETTINGS, ()).motion
    motion = replace(motion, time_ms=motion.time_ms * 40, speed=motion.speed / 40)
    slow.write_text(program_text(motion, SETTINGS, ["slow"]))
    assert pmac("approach", port, slow) == 0 and pmac("download", port, slow) == 0
    for act, ended in [
        (lambda system: system.set_override(130.0), "set from elsewhere: the motion is certified for at most 100 %"),
        (lambda system: system.abort(), "it ended"),
    ]:
        threading.Thread(target=when_it_runs, args=(made, act)).start()
        assert pmac("run", port, slow) == 1
        assert ended in capsys.readouterr().err
        assert pmac("abort", port) == 0
        made.systems[0].set_override(100.0)
        assert pmac("approach", port, slow) == 0


def when_it_runs(made, act):
    until = time.monotonic() + LONGEST_S
    while not made.runs_program() and time.monotonic() < until:
        time.sleep(0.01)
    act(made.systems[0])


def until_it_rests(made):
    until = time.monotonic() + LONGEST_S
    while made.runs_program():
        assert time.monotonic() < until
        time.sleep(0.01)


@pytest.mark.parametrize(
    "arguments",
    [
        ["jog", "--strut", "7"],
        ["jog", "--x", "nan"],
        ["jog", "--feed", "0"],
        ["jog", "--number", "1000"],
        ["approach"],
        ["approach", "x.pmc", "--feed", "0"],
        ["home", "--trigger", "I5190=1"],
        ["override", "120"],
        ["override", "0.001"],
        ["step", "x.pmc", "--block", "0"],
        ["mdi"],
        ["continue", "x.pmc"],
        ["continue", "x.pmc", "--stop", "0"],
    ],
)
def test_arguments_without_sense_by_hand(arguments):
    action, *rest = arguments
    with pytest.raises(SystemExit) as refused:
        main(["pmac", action, "--port", "tcp:127.0.0.1:1", "--machine", MACHINE, *rest])
    assert refused.value.code == 2


@pytest.mark.parametrize(
    ("name", "connected", "reported"),
    [("hold", False, True), ("run", False, False), ("run", True, True), ("status", True, False)],
)
def test_when_people_are_shown_what_to_do(name, connected, reported, capsys):
    print_emergency_steps(name, connected)
    assert ("EMERGENCY STOP" in capsys.readouterr().err) == reported
