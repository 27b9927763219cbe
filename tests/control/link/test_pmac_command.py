# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``pmac`` against a simulated controller behind a TCP port and behind a pseudo terminal."""

import io
from pathlib import Path

import numpy as np
import pytest
from rig import served

from pkm_post.cli import main
from pkm_post.control.link.ownership import lock_path
from pkm_post.control.link.ports import port_named
from pkm_post.control.simulator import Controller
from pkm_post.machine import machine_named
from pkm_post.model import StrutMotion
from pkm_post.system.lock import try_lock
from pkm_post.writing.controllers.pmac import program_text, settings_of, setup_text

MACHINE = "example_6tps"


@pytest.fixture(scope="module")
def machine():
    return machine_named(MACHINE)[0]


@pytest.fixture(scope="module")
def job(machine, tmp_path_factory):
    """All struts 10 mm longer and back, in a minute."""
    settings, _ = settings_of(machine)
    time_ms = np.arange(0, 60_001, 200)
    turn = 2 * np.pi * time_ms / 60_000
    length = settings.zero_length + 5 * (1 - np.cos(turn))[:, None]
    speed = (np.pi / 6 * np.sin(turn))[:, None] * np.ones(6)
    speed[[0, -1]] = 0.0
    file = tmp_path_factory.mktemp("job") / "job.pmc"
    file.write_text(program_text(StrutMotion(time_ms, length, speed, ()), settings, ["job"]))
    return file


@pytest.fixture(params=["tcp", "serial"])
def simulator(request, machine):
    """A controller that serves in a thread, and the name of its port."""
    made = Controller()
    made.load(setup_text(settings_of(machine)[0], "test", machine.strut_stroke).splitlines())
    with served(made, request.param) as port:
        yield made, port


def pmac(action, port, *arguments, machine=MACHINE):
    named = ["--machine", machine] if machine else []
    by_hand = ["--uncertified"] if any(isinstance(argument, Path) for argument in arguments) else []
    return main(["pmac", action, "--port", port, *named, *by_hand, *map(str, arguments)])


def typed(monkeypatch, port, *lines):
    monkeypatch.setattr("sys.stdin", io.StringIO("\n".join(lines) + "\n"))
    assert pmac("terminal", port, machine=None) == 0


@pytest.mark.slow
def test_from_the_first_word_to_the_end_of_a_job(simulator, job, capsys, monkeypatch):
    made, port = simulator
    assert pmac("probe", port) == 0
    assert "set up for Example 6-TPS" in capsys.readouterr().out
    assert pmac("download", port, job) == 0
    assert "listed back as sent, SHA-256" in capsys.readouterr().out
    assert pmac("run", port, job) == 1
    assert "strut 1: not homed" in capsys.readouterr().err and not made.runs_program()
    typed(monkeypatch, port, "", *(f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)), "P1=25", "P1", "FOO")
    assert capsys.readouterr().out.endswith(
        "done\n25\nthe controller refused 'FOO': ERR003, not understood, or wrong data\n"
    )
    assert pmac("run", port, job, "--no-watch") == 0
    assert "a program runs" in capsys.readouterr().out
    assert pmac("hold", port) == 0 and pmac("resume", port) == 0
    assert pmac("abort", port) == 0 and not made.runs_program()
    capsys.readouterr()
    assert pmac("status", port) == 0
    assert "strut 6:" in (reported := capsys.readouterr().out) and "no program runs" in reported


def test_bytes_that_do_not_belong_are_named_before_anything_is_sent(simulator, job, tmp_path, capsys):
    made, port = simulator
    file = tmp_path / "job.pmc"
    file.write_bytes(job.read_bytes().replace(b";", b";\x0b", 1))
    assert pmac("download", port, file) == 1
    assert "job.pmc: line 1:2: error C108" in capsys.readouterr().err
    file.write_bytes(job.read_bytes().replace(b"\n", b"\r\n"))
    assert pmac("download", port, file) == 0
    assert "listed back as sent" in capsys.readouterr().out


@pytest.mark.slow
def test_a_program_too_large_is_streamed(simulator, machine, tmp_path, capsys, monkeypatch):
    made, port = simulator
    settings, _ = settings_of(machine)
    time_ms = np.arange(0, 1001, 20)
    turn = 2 * np.pi * time_ms / 500
    speed = (2 * np.pi * np.sin(turn))[:, None] * np.ones(6)
    speed[::25] = 0.0
    length = settings.zero_length + 0.5 * (1 - np.cos(turn))[:, None]
    file = tmp_path / "large.pmc"
    file.write_text(program_text(StrutMotion(time_ms, length, speed, ()), settings, ["large"]))
    typed(monkeypatch, port, *(f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)), "&1DEFINE ROT 600")
    capsys.readouterr()
    assert pmac("stream", port, "--rotary", 200, file) == 1
    assert "the program does not rest between its lines" in capsys.readouterr().err
    assert pmac("stream", port, "--rotary", 600, file) == 0
    assert "lines carried out in 4 segments, SHA-256" in capsys.readouterr().out
    assert not made.runs_program() and made.systems[0].path.abrupt_stops == 0


def test_the_readout(simulator, capsys):
    _, port = simulator
    assert pmac("monitor", port, "--seconds", 0.2) == 0
    reported = capsys.readouterr().out
    # The motors stand where the lengths are those of home_tip with the tool of the rest pose, rounded to 0.1 um.
    assert "Z300.000 mm, axis I0.00000 J" in reported.replace("-0.", "0.") and "0.000 deg from upright" in reported


def test_another_set_up_is_not_loaded_into(simulator, job, capsys, monkeypatch):
    made, port = simulator
    typed(monkeypatch, port, "I5190=60000")
    assert pmac("download", port, job) == 1
    assert "I5190: expected 1000" in capsys.readouterr().err
    assert 10 not in made.memory.programs


def test_a_program_that_is_none(simulator, tmp_path, capsys):
    _, port = simulator
    file = tmp_path / "none.pmc"
    file.write_text("CLOSE\nQ\n")
    assert pmac("download", port, file) == 1
    assert "none.pmc: line 2:" in capsys.readouterr().err
    assert pmac("download", port, tmp_path / "missing.pmc") == 1
    assert pmac("status", port, machine="nothing") == 1


def test_nobody_there(capsys, job):
    assert pmac("status", "tcp:127.0.0.1:1") == 1
    refused = capsys.readouterr().err
    assert refused.startswith("tcp:127.0.0.1:1: error C216: no controller answers as expected: ")
    assert "the connection is refused; check power, cable, " in refused


@pytest.mark.parametrize(
    ("port", "reason"),
    [
        ("serial:/nowhere", "/nowhere: there is no such port"),
        ("tcp:nobody.invalid", "nobody.invalid, port 1025: no computer"),
    ],
)
def test_a_missing_peer_is_explained_in_plain_words(port, reason, capsys, job):
    assert pmac("status", port) == 1
    refused = capsys.readouterr().err
    assert f"error C216: no controller answers as expected: {reason}" in refused and "Errno" not in refused


@pytest.mark.parametrize("arguments", [["--port", "usb:1"], [], ["--port", "tcp:h", "--patience", "0"]])
def test_arguments_without_sense(arguments):
    with pytest.raises(SystemExit) as refused:
        main(["pmac", "status", "--machine", MACHINE, *arguments])
    assert refused.value.code == 2


@pytest.mark.slow
def test_one_client_has_the_machine_and_the_others_watch_and_stop(simulator, job, capsys, monkeypatch):
    made, port = simulator
    typed(monkeypatch, port, *(f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)))
    assert pmac("download", port, job) == 0 and pmac("run", port, job, "--no-watch") == 0
    name = port_named(port).name
    with try_lock(lock_path(name)) as lock:
        lock.describe({"user": "anna", "process": 4711, "what": "jog", "since": 0})
        orders = [("download", job), ("run", job), ("stream", job), ("jog", "--x", 1), ("mdi", "G1 X1 F100")]
        for order in (*orders, ("resume",), ("override", 50), ("home", "--trigger", "#1HM")):
            capsys.readouterr()
            assert pmac(order[0], port, *order[1:]) == 1
            reported = capsys.readouterr().err
            if order[0] not in ("jog", "mdi"):  # they see first that the machine moves, and plan nothing
                owner = "process 4711 of anna, jog, since"
                assert f"{name}: error C210: another client controls the machine: {owner}" in reported
        monkeypatch.setattr("sys.stdin", io.StringIO("#1P\nP5=1\nLIST PC P5=1\nLIST PROG 999\n&1H\n"))
        assert pmac("terminal", port, machine=None) == 1
        assert capsys.readouterr().out.count("error C210") == 2 and made.variables.read("P", 5) == 0
        assert pmac("hold", port) == 0 and pmac("status", port) == 0 and pmac("probe", port) == 0
        assert "a program is held" in capsys.readouterr().out
        assert pmac("abort", port) == 0
    assert not made.runs_program()
    assert pmac("override", port, 50) == 0


def test_probe_says_that_the_machine_moves(simulator, capsys, monkeypatch):
    made, port = simulator
    assert pmac("probe", port) == 0
    assert "no program runs, override 100 %" in capsys.readouterr().out
    assert pmac("probe", port, machine=None) == 0
    assert "no program runs, and no motor moves" in capsys.readouterr().out
    typed(monkeypatch, port, *(f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)), "#3J+")
    capsys.readouterr()
    assert pmac("probe", port) == 0
    assert "no program runs, BUT THE MACHINE MOVES" in capsys.readouterr().out
    assert pmac("probe", port, machine=None) == 0
    assert "a program runs, or a motor moves" in capsys.readouterr().out
    assert pmac("jog", port, "--x", 1) == 1
    assert "a strut moves" in capsys.readouterr().err
