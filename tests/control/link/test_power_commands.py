# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands on a simulated Power PMAC over ssh: a posted program is loaded, verified, started and stopped."""

import io
import re
import threading
import time
from pathlib import Path

import paramiko
import pytest
from power_rig import DRIVES

from pkm_post.cli import main
from pkm_post.control.link.program import parse_power_program
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.simulator import PowerPmac, Server
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.machine import find_machine

EXAMPLE = Path(__file__).parents[3] / "examples" / "first.ngc"
SPEED, LONGEST_S = 8.0, 120.0
SECRET = "of the simulated user"


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """The machine with a Power PMAC, and a program that was posted for it."""
    folder = tmp_path_factory.mktemp("posted")
    machine = folder / "power.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    machine.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    arguments = ["--machine", str(machine), "--tool-length", "1=120", "--out", str(folder / "out")]
    assert main(["post", str(EXAMPLE), *arguments]) == 0
    return machine, folder / "out" / "first.pmc"


@pytest.fixture
def pmac(posted, tmp_path, monkeypatch):
    """Run one action on a Power PMAC that serves until the end of the test; also what is served."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("SSH_AUTH_SOCK", raising=False)
    monkeypatch.setenv(PASSWORD, SECRET)
    machine = PowerPmac()
    lines = posted[1].with_name("first-setup.cfg").read_text().splitlines()
    lines += [f"Motor[{motor}].{drive}" for motor in range(1, 7) for drive in DRIVES]
    assert refused_line(machine, [*lines, *(f"#{motor}j/ #{motor}hmz" for motor in range(1, 7))]) is None
    machine.controller.advance(100)
    server, ended = Server(machine.controller, SPEED), threading.Event()
    door = server.add_ssh(machine, ssh_package(), 0, SECRET)
    known = tmp_path / "known"
    known.write_text(f"{door.known_host}\n")
    thread = threading.Thread(target=server.run, args=(ended.is_set,))
    thread.start()

    def act(action, *arguments):
        port = ["--port", f"ssh:{door.user}@127.0.0.1:{door.number}", "--known-hosts", str(known), "--patience", "30"]
        return main(["pmac", action, *port, *arguments])

    act.machine, act.number = machine, door.number
    yield act
    ended.set()
    thread.join(LONGEST_S)
    server.close()


@pytest.mark.slow
def test_a_posted_program_is_loaded_verified_and_run(pmac, posted, capsys):
    machine, program = posted
    assert pmac("probe", "--machine", str(machine)) == 0
    assert "CID: 604020\n" in (said := capsys.readouterr().out) and "set up for Example 6-TPS" in said
    assert pmac("download", "--machine", str(machine), str(program)) == 0
    sent = parse_power_program(program.read_text()).lines
    assert f"program 10: {len(sent)} lines, listed back as sent, SHA-256 " in capsys.readouterr().out
    assert pmac("run", "--machine", str(machine), str(program), "--no-watch") == 0
    assert "a program runs" in capsys.readouterr().out
    assert pmac("hold", "--machine", str(machine)) == 0
    assert "a program is held, override 0 %" in capsys.readouterr().out
    assert pmac("resume", "--machine", str(machine)) == 0
    assert pmac("override", "--machine", str(machine), "90") == 0
    system, until = pmac.machine.controller.systems[0], time.monotonic() + LONGEST_S
    while system.running:
        assert time.monotonic() < until
        time.sleep(0.05)
    assert not system.runtime_error and system.path.abrupt_stops == 0
    assert pmac("abort", "--machine", str(machine)) == 0


def test_another_program_in_the_controller_is_not_started(pmac, posted, capsys):
    machine, program = posted
    assert pmac("download", "--machine", str(machine), str(program)) == 0
    pmac.machine.controller.memory.programs[10].source[20] += " dwell5"
    assert pmac("run", "--machine", str(machine), str(program)) == 1
    assert "program 10 in the controller is a different one: line 21" in capsys.readouterr().err
    assert not pmac.machine.controller.runs_program()


@pytest.mark.parametrize(("user", "password"), [("root", "deltatau"), ("me", SECRET)])
def test_others_are_not_let_in(pmac, user, password):
    client = paramiko.SSHClient()
    client.set_missing_host_key_policy(paramiko.AutoAddPolicy())
    with pytest.raises(paramiko.AuthenticationException):
        client.connect("127.0.0.1", pmac.number, user, password, look_for_keys=False, allow_agent=False)
    client.close()


def test_the_simulator_says_how_to_get_in(monkeypatch, capsys, posted):
    seen = []

    def run(server, ended):
        seen.append(server)
        raise KeyboardInterrupt

    monkeypatch.setattr(Server, "run", run)
    monkeypatch.delenv(PASSWORD, raising=False)
    setup = ["--setup", str(posted[1].with_name("first-setup.cfg"))]
    assert main(["pmac", "simulate", "--ssh", "0", *setup]) == 1
    assert f"set the password of the simulated user in {PASSWORD}" in capsys.readouterr().err
    monkeypatch.setenv(PASSWORD, SECRET)
    assert main(["pmac", "simulate", "--ssh", "0", *setup]) == 0
    said = capsys.readouterr().out
    assert re.search(r"^\[127\.0\.0\.1\]:[0-9]+ ecdsa-sha2-nistp256 \S+$", said, re.MULTILINE)
    assert re.search(r"A simulated Power PMAC is at ssh:root@127\.0\.0\.1:[0-9]+; Ctrl-C ends it\.\nended\n$", said)
    assert seen and seen[0]._controller.systems[0].axes.definitions[6].text() == "10000W-10078869"


def test_a_set_up_line_that_is_refused_is_reported_with_its_place(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(PASSWORD, SECRET)
    file = tmp_path / "setup.cfg"
    file.write_text("&1\nCoord[1].Foo=1\n")
    assert main(["pmac", "simulate", "--ssh", "0", "--setup", str(file)]) == 1
    assert capsys.readouterr().err == f"{file}:2: error #20, ILLEGAL CMD: Coord[1].Foo=1\n"


@pytest.mark.slow
def test_a_posted_trajectory_is_played(pmac, posted, capsys, monkeypatch):
    machine, program = posted
    monkeypatch.setattr("sys.stdin", io.StringIO("override 120\n"))
    assert pmac("play", "--machine", str(machine), str(program.with_suffix(".pkmt"))) == 0
    said = capsys.readouterr()
    assert "deviation of the tool tip" in said.out and not said.err
    system = pmac.machine.controller.systems[0]
    assert not system.running and not system.runtime_error and system.path.abrupt_stops == 0


@pytest.mark.slow
def test_the_tool_is_jogged_and_moved_by_a_line(pmac, posted, capsys):
    machine = ["--machine", str(posted[0])]
    assert pmac("jog", *machine, "--x", "2", "--feed", "600") == 0
    said = capsys.readouterr().out
    within = float(re.search(r"it rests within ([\d.]+) s if this computer falls silent", said)[1])
    assert 0.1 < within < 5.0 and "arrived; no strut is off" in said
    assert pmac("mdi", *machine, "G91 G1 X-2 Z1 F600") == 0
    assert "to tip X0.000 Y0.000 Z301.000" in capsys.readouterr().out.replace("-0.000", "0.000")
    assert pmac("approach", *machine, str(posted[1]), "--check") == 0
