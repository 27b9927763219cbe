# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever comes in: never an exception, and behind it the port answers as before."""

import random

import pytest
from simulated import ready_machine

from pkm_post.control.simulator import Controller, EthernetPort, SerialPort

TEXT = r"""
#1 #7 #33 -> J+ J- J/ J= J=100 J^5 HM HMZ K A R S H Q B10 B0 &1 &2 % %50 %999 P V F ? ?? ??? I3=2 I3=0 I4=1 I4=0
I6=3 I9=3 P1 P1=2 P1..5 M1-> M1->* M1=1 Q127 OPEN PROG 10 OPEN ROT CLOSE CLEAR DEFINE ROT 50 DELETE ROT DELETE
GATHER DEFINE GATHER SIZE LIST PROG 10 LIST PC PR VER TYPE CID SAVE $$$ UNDEFINE ALL 1000A X10 A510:5 PVT20
LINEAR TA100 TS0 F10 DWELL0 DWELL5 IF(P1>1) WHILE(P1<3) ENDWHILE ENDIF ELSE N10 GOTO10 CALL10 RETURN STOP M3 M0
G4 T5 S100 M5==1 CMD"P1" SEND"x" ABS INC( ( ) ; .. = == O0 E \ BLOCKSTART BLOCKSTOP FRAX(A,B) PASSWORD=x ##1 --
1e9 $FFFF 99999999999
"""
WORDS = TEXT.split()


def chance_line(chance):
    return "".join(chance.choice(WORDS) + chance.choice(["", " ", " "]) for _ in range(chance.randint(1, 6)))


def assert_alive(line):
    line.receive(b"\x18\r\x01")
    line.receive(b"CLOSE\r")
    line.receive(b"I3=2\rI4=0\rI6=1\rP99=7\r")
    assert line.receive(b"P99\r") == b"7\r\x06"
    assert line.receive(b"FOO\r") == b"\x07ERR003\r"


@pytest.mark.parametrize("seed", range(8))
def test_bytes_of_chance(seed):
    chance = random.Random(seed)
    line = SerialPort(Controller())
    for _ in range(60):
        line.receive(chance.randbytes(chance.randint(1, 100)))
        line.controller.advance(chance.choice([0, 1, 5]))
    assert_alive(line)


@pytest.mark.parametrize("seed", range(12))
def test_commands_of_chance(seed):
    chance = random.Random(seed)
    machine = ready_machine(memory_words=1500)
    machine.lines("OPEN PROG 10\nCLEAR\nLINEAR TM50\nA510\nPVT20\nA511:5\nDWELL5\nCLOSE")
    for _ in range(150):
        machine.bytes(chance_line(chance).encode() + b"\r")
        machine.wait(chance.choice([0, 1, 20]))
    assert_alive(machine.line)


@pytest.mark.parametrize("seed", range(8))
def test_packets_of_chance(seed):
    chance = random.Random(seed)
    port = SerialPort(Controller())
    link = EthernetPort(port)
    for _ in range(200):
        head = bytes([chance.choice([0x40, 0xC0, chance.randrange(256)]), chance.choice([*range(0xB0, 0xCC)])])
        data = chance_line(chance).encode()
        length = chance.choice([len(data), chance.randrange(2000)])
        link.receive(head + bytes(4) + length.to_bytes(2, "big") + data)
        port.controller.advance(chance.choice([0, 1]))
    assert_alive(port)


@pytest.mark.parametrize("cut", range(1, 60))
def test_a_download_that_is_cut_anywhere_leaves_nothing_that_moves(cut):
    machine = ready_machine()
    text = b"OPEN PROG 10\rCLEAR\rLINEAR TM100\rA510 B510\rA520\rCLOSE\r"
    machine.bytes(text[:cut])
    machine.wait(200)
    machine.bytes(b"\x18")  # what is left of a line
    assert not machine.runs() and machine.controller.motors.commanded.tolist() == [0.0] * 6
    assert_alive(machine.line)


HUGE = "9" * 240


@pytest.mark.parametrize(
    "line",
    [
        "P1=" + "+".join("1" * 126),
        "P1=" + "-" * 250 + "1",
        f"P1={HUGE}*{HUGE[:5]}",
        f"#1->{HUGE}X",
        f"#1J={HUGE}",
        f"I122={HUGE} #1J+",
        f"I124={HUGE} #1J+",
        "I5194=-1 %50",
        "I5190=-1 R",
        f"%{HUGE}",
        f"I116={HUGE} I117={HUGE} R",
        "I116=0 I117=0 I115=0 I119=0 I122=0 R",
        f"DEFINE ROT {HUGE}",
        f"#{HUGE}P",
        f"LIST PROG {HUGE}",
    ],
)
def test_numbers_beyond_all_bounds(line):
    machine = ready_machine()
    machine.lines("OPEN PROG 10\nCLEAR\nLINEAR TM50\nA510\nPVT20\nA511:5\nDWELL5\nCLOSE\nB10")
    machine.bytes(line.encode() + b"\r")
    for _ in range(20):
        machine.wait(10)
        machine.bytes(b"#1P #1V #1F #1? ??\r\x10\x06")
    assert_alive(machine.line)


@pytest.mark.parametrize(
    "body",
    [f"PVT(P1*4000)\nA1:{HUGE}", f"TA{HUGE} A{HUGE}", f"TM{HUGE} A1", f"G{HUGE}", "G(-5)", f"CALL{HUGE}", f"GOTO{HUGE}",
     f"DWELL{HUGE}", f"DWELL(-{HUGE})", f"F{HUGE} A1", f"A{HUGE} B{HUGE}", f"PVT1 A{HUGE}:{HUGE}", "TM0 TA0 TS0 A600",
     f"P{HUGE[:5]}=1", "M(P1)==1 A1", f"INC A{HUGE}\nA{HUGE}\nA{HUGE}"],
)  # fmt: skip
def test_programs_beyond_all_bounds(body):
    machine = ready_machine()
    machine.bytes(f"P1={HUGE}\rOPEN PROG 10\rCLEAR\rLINEAR F10\r".encode() + body.replace("\n", "\r").encode())
    machine.bytes(b"\rCLOSE\rB10R\r")
    for _ in range(20):
        machine.wait(10)
        machine.bytes(b"#1P #1V #1F #1? ??\r")
    assert_alive(machine.line)


def test_long_lines_by_ethernet_are_refused_as_well():
    port = SerialPort(Controller())
    data = ("P1=" + "+".join("1" * 700)).encode()
    answer = EthernetPort(port).receive(b"\x40\xbf\0\0\0\0" + len(data).to_bytes(2, "big") + data)
    assert answer == b"\x07\nERR003\r"
