# SPDX-License-Identifier: LGPL-2.1-or-later
"""Talk to the simulated Turbo PMAC with dls_pmaclib, a client that others wrote, by TCP.

    python3 tests/oracles/pmac_dls_pmaclib.py

Needs numpy and dls-pmaclib from PyPI. It was run with 3.1.2, which asks for Python 3.11 or 3.12. Prints every exchange
and ends with an error when one is not as the client's own rules and the manuals have it.
"""

import re
import sys
import threading
from pathlib import Path

from dls_pmaclib.dls_pmacremote import PmacEthernetInterface

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT)]

from pkm_post.control.simulator import Controller, Server  # noqa: E402

SPEED = 5.0
SHOWN = 160
PROGRAM = """\
CLOSE
DELETE GATHER
OPEN PROG 10
CLEAR
ABS
FRAX(A,B,C,U,V,W)
LINEAR
TA100 TS0 F10
A0.1 B0.1 C0.1 U0.1 V0.1 W0.1
DWELL0
PVT20
A0.1625:3.125 B0.1625:3.125 C0.1625:3.125 U0.1625:3.125 V0.1625:3.125 W0.1625:3.125
A0.225:0 B0.225:0 C0.225:0 U0.225:0 V0.225:0 W0.225:0
DWELL0
LINEAR
CLOSE
"""


class Talk:
    """The client, and what it was sent."""

    def __init__(self, port):
        self.client = PmacEthernetInterface()
        self.client.setConnectionParams("127.0.0.1", port)
        failure = self.client.connect()
        print(f"connect: {failure!r}")
        assert failure is None
        assert self.client.isConnectionOpen

    def say(self, command, expected):
        answer, succeeded = self.client.sendCommand(command)
        print(f"{command!r}: {answer[:SHOWN]!r}{f' and {len(answer) - SHOWN} more' * (len(answer) > SHOWN)}")
        assert succeeded, command
        assert re.fullmatch(expected, answer), f"expected {expected!r}"
        return answer


def talk_to(port):
    talk = Talk(port)
    print(f"model: {talk.client.getPmacModel()!r}, axes: {talk.client.getNumberOfAxes()}")
    talk.say("#1P", "0\r\x06")
    talk.say("FOO", "\x07ERR003\r")
    talk.say("X10", "\x07ERR005\r")
    for motor, letter in enumerate("ABCUVW", start=1):
        talk.say(f"&1#{motor}->10000{letter}", "\x06")
        talk.client.jogStop(motor)
        print("home:", talk.client.homeCommand(motor))
    reported = list(talk.client.sendSeries(list(enumerate(PROGRAM.splitlines(), start=1))))
    print(f"download: {sum(good for good, *_ in reported)} of {len(reported)} lines taken")
    assert all(good for good, *_ in reported)
    listing = talk.say("LIST PROG 10", "(?s).*RET\r\x06")
    assert "A0.1625:3.125B0.1625:3.125" in listing
    # More than the 1400 bytes of one answer. Lines of 11 bytes, for the client takes an answer whose last byte is a
    # carriage return for an error, be it complete or not.
    talk.say("P0..999=1234567.25", "\x06")
    many = talk.say("P0..999", "(?s).*\x06")
    assert many.count("\r") == 1000
    wait_for(talk, "&1??", lambda words: int(words[6:12], 16) & 1 << 17, "in position after the search for home")
    for motor in range(1, 7):
        assert int(talk.say(f"#{motor}?", "[0-9A-F]{12}\r\x06")[6:12], 16) & 1 << 10, "home complete"
    talk.say("I5190", "1000\r\x06")
    talk.say("&1B10R", "\x06")
    wait_for(talk, "&1??", lambda words: not int(words[:6], 16) & 1, "program ended")
    for motor in range(1, 7):
        talk.say(f"#{motor}P", "2250\r\x06")
    print(f"jog: {talk.client.jogInc(1, 'pos', 100)}")
    wait_for(talk, "#1P", lambda position: position.startswith("2350"), "jogged by 100 counts")
    talk.client.disconnect()
    print("all as expected")


def wait_for(talk, command, holds, what):
    for _ in range(2000):
        answer, _ = talk.client.sendCommand(command)
        if holds(answer):
            print(f"{command!r}: {answer!r} ({what})")
            return
    raise AssertionError(f"{what}: still {answer!r}")


def main():
    server = Server(Controller(), SPEED)
    port = server.add_tcp(0)
    done = threading.Event()
    thread = threading.Thread(target=server.run, args=(done.is_set,))
    thread.start()
    try:
        talk_to(port)
    finally:
        done.set()
        thread.join()
        server.close()


if __name__ == "__main__":
    main()
