# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from pathlib import Path

import pytest

from pkm_post.cli import main
from pkm_post.control.simulator import Server
from pkm_post.writing import manifest


@pytest.fixture
def interrupted(monkeypatch):
    """The user interrupts as soon as the server runs; it is handed out for a look."""
    seen = []

    def run(server, ended):
        seen.append(server)
        raise KeyboardInterrupt

    monkeypatch.setattr(Server, "run", run)
    return seen


def test_it_tells_where_it_is_and_ends_when_it_is_interrupted(interrupted, capsys):
    assert main(["pmac", "simulate", "--tcp", "0"]) == 0
    assert re.fullmatch(
        r"A simulated Turbo PMAC is at tcp:127\.0\.0\.1:[0-9]+; Ctrl-C ends it\.\nended\n", capsys.readouterr().out
    )
    assert main(["pmac", "simulate", "--pty", "--speed", "2", "--memory", "5000"]) == 0
    assert re.match(r"A simulated Turbo PMAC is at serial:/dev/", capsys.readouterr().out)
    assert interrupted[1]._controller.settings.memory_words == 5000


def test_a_set_up_file_is_carried_out_first(interrupted, tmp_path):
    file = tmp_path / "setup.pmc"
    file.write_text("; a comment\n&2\n#1->10000A-5000000 ; strut 1\nI5290=1000\n")
    assert main(["pmac", "simulate", "--tcp", "0", "--setup", str(file)]) == 0
    assert interrupted[0]._controller.systems[1].axes.definitions[1].text() == "10000A-5000000"


def test_it_has_programs_behind_the_m_codes_of_its_machine(interrupted, tmp_path, capsys):
    file = machine_file(tmp_path, 'functions = { M21 = "M21", M121 = "M121", M44 = "M60==1 DWELL0" }\n')
    assert main(["pmac", "simulate", "--tcp", "0", "--machine", str(file)]) == 0
    made = interrupted[0]._controller
    for number in (21, 121):
        made.load(["&1 #1->1000X #1J/", "OPEN PROG 5 CLEAR", f"M{number} DWELL0", "CLOSE", "&1 B5 R"])
        made.advance(50)
        assert made.variables.read("P", 7004) == number and not made.runs_program()
    assert main(["pmac", "simulate", "--tcp", "0", "--machine", "no_such"]) == 1
    assert "M10" in capsys.readouterr().err


def machine_file(folder, codes):
    """The example machine with more lines in its table of codes."""
    text = (Path(__file__).parents[3] / "resources/machines/example_6tps.toml").read_text()
    assert "[controller.codes]\n" in text
    file = folder / "functions.toml"
    file.write_text(text.replace("[controller.codes]\n", f"[controller.codes]\n{codes}"))
    return file


def test_a_line_that_is_refused_is_reported_with_its_place(interrupted, tmp_path, capsys):
    file = tmp_path / "setup.pmc"
    file.write_text("&1\nFOO=1\n")
    assert main(["pmac", "simulate", "--tcp", "0", "--setup", str(file)]) == 1
    assert capsys.readouterr().err == f"{file}:2: ERR003, data error or unrecognized command: FOO=1\n"
    assert main(["pmac", "simulate", "--tcp", "0", "--setup", str(tmp_path / "none.pmc")]) == 1
    assert "none.pmc" in capsys.readouterr().err
    assert not interrupted


def test_a_port_that_is_taken_is_reported(capsys):
    from pkm_post.control.simulator import Controller

    server = Server(Controller())
    port = server.add_tcp(0)
    assert main(["pmac", "simulate", "--tcp", str(port)]) == 1
    assert capsys.readouterr().err.startswith("no connection can be offered: ")
    server.close()


@pytest.mark.parametrize(
    ("arguments", "reported"),
    [
        ([], "error U102: an argument is missing: one of --pty --tcp --ssh; "),
        (["--pty", "--tcp", "1"], "not allowed with argument --pty"),
        (["--tcp", "65536"], "expected a port from 0 to 65535, got '65536'"),
        (["--tcp", "x"], "expected a port from 0 to 65535, got 'x'"),
        (["--pty", "--speed", "0"], "expected a number from 0.01 to 100.0, got '0'"),
        (["--pty", "--speed", "x"], "expected a number from 0.01 to 100.0, got 'x'"),
        (["--pty", "--probed", "cone:1"], "expected plane:Z, bore:X,Y,Z,DIAMETER or boss:X,Y,Z,DIAMETER, got 'cone:1'"),
        (["--pty", "--memory", "999"], "expected 1000 words or more, got '999'"),
    ],
)
def test_arguments_without_sense_are_refused(arguments, reported, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["pmac", "simulate", *arguments])
    assert ended.value.code == 2
    assert reported in capsys.readouterr().err


def test_a_probe_needs_the_machine_that_carries_it(capsys):
    assert main(["pmac", "simulate", "--tcp", "0", "--probed", "plane:3"]) == 2
    assert "--probed: error U102: an argument is missing: --machine; " in capsys.readouterr().err
    assert main(["pmac", "simulate", "--ssh", "0", "--probed", "plane:3", "--machine", "example_6tps"]) == 1
    assert "kind: expected power_pmac, got 'turbo_pmac'" in capsys.readouterr().err
    assert main(["pmac", "simulate", "--tcp", "0", "--probed", "plane:3", "--machine", "none_of_these"]) == 1
    assert "none_of_these" in capsys.readouterr().err


def test_a_set_up_that_has_changed_since_it_was_posted_is_refused(tmp_path, capsys):
    file = tmp_path / "part-setup.pmc"
    file.write_text("I15=0\n")
    manifest.write(tmp_path, "part")
    file.write_text("I15=1\n")
    assert main(["pmac", "simulate", "--tcp", "0", "--setup", str(file)]) == 1
    assert "error F106" in (reported := capsys.readouterr().err) and "part-setup.pmc has changed" in reported
