# SPDX-License-Identifier: LGPL-2.1-or-later
"""The simulated Power PMAC: its language, its data structure, its answers and its refusals."""

import pytest

from pkm_post.control.simulator import CommandError, GpasciiShell, PowerPmac
from pkm_post.control.simulator.gpascii_shell import POWER_ERRORS, refused_line
from pkm_post.control.simulator.power_online import GpasciiThread
from pkm_post.control.simulator.power_program import listed_line


@pytest.fixture
def machine():
    return PowerPmac()


@pytest.fixture
def thread(machine):
    made = GpasciiThread(machine)
    made.execute("echo 7")
    return made


def loaded(thread, *lines, number=10):
    for line in (f"open prog {number}", *lines, "close"):
        assert thread.execute(line) == []
    return thread.execute(f"list prog {number}")


def run(machine, thread, *lines):
    """What a program leaves in P1."""
    assert refused_line(machine, ["&1 #1->1000X", "#1j/ #1hmz"]) is None
    loaded(thread, *lines)
    thread.execute("&1b10r")
    machine.controller.advance(1000)
    assert not machine.controller.systems[0].running
    return float(thread.execute("P1")[0])


def test_it_is_what_a_shell_says(machine):
    shell = GpasciiShell(machine)
    assert shell.receive(b"ls\n") == b"ls\r\nsh: not found\r\nroot@ppmac:/opt/ppmac# "
    assert shell.receive(b"gpascii -2\n") == b"gpascii -2\r\nSTDIN Open for ASCII Input\r\n"
    assert shell.receive(b"P1=2.5") == b"" and shell.receive(b"\nP1\n") == b"P1=2.5\r\n\x06\r\nP1\r\nP1=2.5\r\n\x06\r\n"
    assert shell.receive(b"echo 7\nP1\n") == b"echo 7\r\n\x06\r\nP1\r\n2.5\r\n\x06\r\n"
    assert shell.receive(b"foo\n") == b"foo\r\nstdin:5:1: error #20: ILLEGAL CMD: foo\r\n\x06\r\n"


def test_the_error_comes_before_the_answers_of_the_commands_ahead_of_it(machine):
    """As a client of the Australian Synchrotron notes it: ``#1p #2p gooble`` is answered by error, 0, -11.49609375."""
    shell = GpasciiShell(machine)
    shell.receive(b"gpascii -2\necho 7\n")
    said = shell.receive(b"P1=5 P1 Sys.MaxCoords gooble\n").split(b"\r\n")
    assert said[1].startswith(b"stdin:2:1: error #20: ILLEGAL CMD") and said[2:] == [b"5", b"16", b"\x06", b""]


@pytest.mark.parametrize(
    ("line", "listed"),
    [
        ("LINEAR // slowly", "linear"),
        ("A512.062500:3.1250 B-513.000000:-0.5000", "A512.0625:3.125 B-513:-0.5"),
        ("A1007.886888123456:1e-5", "A1007.886888123456:0.00001"),
        ("Frax( A,B )", "frax( A,B )"),
        ('send"Text 1.50"', 'send"Text 1.50"'),
    ],
)
def test_lines_are_listed_with_the_numbers_that_are_kept(line, listed):
    assert listed_line(line) == listed


def test_numbers_are_doubles(thread):
    thread.execute("P1=1007.886888123456789")
    assert float(thread.execute("P1")[0]) == 1007.886888123456789
    thread.execute("P2=1/3")
    assert float(thread.execute("P2")[0]) == 1 / 3


def test_opening_a_program_erases_it_and_closing_an_empty_one_deletes_it(thread):
    assert loaded(thread, "linear", "X1") == ["linear", "X1"]
    assert loaded(thread, "abs") == ["abs"]
    thread.execute("open prog 10")
    thread.execute("close")
    with pytest.raises(CommandError) as refused:
        thread.execute("list prog 10")
    assert POWER_ERRORS[refused.value.number] == (22, "PROGRAM NOT IN BUFFER")


@pytest.mark.parametrize(
    ("lines", "value"),
    [
        (["P1=0", "while (P1 < 5) {", "P1=P1+2", "}"], 6),
        (["P1=0; while (P1<=4) {P1=P1+1}"], 5),
        (["P2=3", "if (P2 == 3 && P2 <> 4) {", "P1=1;", "} else {", "P1=2", "}"], 1),
        (["P2=4", "if (P2 == 3 || P2 >= 5) {", "P1=1", "} else {", "P1=2", "}"], 2),
        (["P1=7", "if (P1 > 8) P1=8"], 7),
        (["P1=1", "gosub 20", "P1=P1*10", "return", "N20:P1=P1+1", "return"], 20),
        (["P1=0", "while(P1<2){", "P1=P1+1", "if(P1==2){", "P1=9", "}", "}"], 9),
    ],
)
def test_the_flow_of_a_program(machine, thread, lines, value):
    assert run(machine, thread, *lines) == value


@pytest.mark.parametrize("lines", [["}"], ["while (P1<1) {", "P1=1"], ["if (P1"], ["foo"], ["X1 /"], ["} else {"]])
def test_what_is_no_program_is_refused_or_does_not_run(machine, thread, lines):
    assert refused_line(machine, ["&1 #1->1000X", "#1j/ #1hmz"]) is None
    thread.execute("open prog 10")
    with pytest.raises(CommandError):
        for line in (*lines, "close"):
            thread.execute(line)
        thread.execute("&1b10r")


def test_slews_are_those_of_a_new_controller(thread):
    """TimeBaseSlew and FeedHoldSlew in pp_save.cfg of Diamond's LabPowerPmac, where nobody changed them."""
    for name in ("TimeBaseSlew", "FeedHoldSlew"):
        assert float(thread.execute(f"Coord[16].{name}")[0]) == pytest.approx(1e-4)


def test_elements_are_converted_and_kept(thread):
    for name, value in (("Motor[1].AbortTa", -0.1), ("motor[2].invamax", 0.05), ("Coord[1].FeedTime", 60000)):
        thread.execute(f"{name}={value}")
        assert float(thread.execute(name)[0]) == pytest.approx(value)


@pytest.mark.parametrize(
    "line",
    ["Motor[1].Foo=1", "Motor[7].MaxPos=1", "Coord[1].ProgRunning=0", "Coord[1].SegMoveTime=5", "Motor[1].JogTa=5",
     "Coord[0].FeedTime=1", "Sys.Foo", "Motor[1].MaxPos=", "P9000=1", "open prog", "&17r", "#1x"],
)  # fmt: skip
def test_what_it_does_not_have_is_refused(thread, line):
    with pytest.raises(CommandError):
        thread.execute(line)


def test_soft_limits_act_while_the_higher_one_is_above_the_lower_one(machine, thread):
    motors = machine.controller.motors
    thread.execute("#1j/ #1hmz")
    motors.actual[0] = motors.commanded[0] = 10.0
    for high, low, beyond in ((0, 0, False), (5, -5, True), (5, 5, False), (0, -5, True), (20, -5, False)):
        thread.execute(f"Motor[1].MaxPos={high}")
        thread.execute(f"Motor[1].MinPos={low}")
        assert motors.at_limits()[0][0] == beyond
        assert (int(thread.execute("#1?")[0].strip("$"), 16) >> 54 & 1) == beyond


def test_a_thread_that_ends_closes_its_buffer(machine):
    one, other = GpasciiThread(machine), GpasciiThread(machine)
    one.execute("open prog 10")
    with pytest.raises(CommandError) as refused:
        other.execute("open prog 11")
    assert POWER_ERRORS[refused.value.number][0] == 33
    one.end()
    assert loaded(other, "linear", number=11) == ["linear"]
