# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated Power PMAC behind a shell: bytes in, bytes out, as clients of others and digests of the manual have it.

It has variables, six motors that stand, and a program that runs until it is stopped; nothing else.
"""

import re

PROMPT = b"root@ppmac:/opt/ppmac# "
LISTENS = b"STDIN Open for ASCII Input\r\n"
CLOSED_LOOP, HOMED, STANDING, ENABLED = 1 << 45, 1 << 47, 1 << 46, 1 << 44
READY = CLOSED_LOOP | HOMED | STANDING | ENABLED
"""Bits of ``#n?`` [EPICSpmac, pmacHardwarePower]."""


class Shell:
    """A shell in which gpascii may be started.

    Attributes:
        said: whatever was sent to gpascii, line by line.
        motors: bits of the six motors.
        positions: of the motors, in motor units.
        elements: of the data structure, by name in small letters.
        acknowledges_start: whether ACK follows the line that gpascii listens.
        acknowledges_refusals: whether ACK follows an error.
        splits: whether CR LF behind an ACK comes with the next answer.
    """

    def __init__(self):
        self.said, self.motors, self.positions = [], [READY] * 6, [0.0] * 6
        self.elements = {f"coord[1].{name}": 0 for name in ("progrunning", "feedhold", "errorstatus")}
        self.elements |= {"sys.maxcoords": 16}
        self.override, self.system = 100.0, 0
        self.acknowledges_start, self.acknowledges_refusals, self.splits = False, True, False
        self.garble = None
        self.greeting()

    def greeting(self):
        """What a log-in says; its shell is a new one."""
        self._in_gpascii, self._values_alone, self._line, self._late = False, False, b"", b""
        return b"Power PMAC\r\n" + PROMPT

    def receive(self, data):
        said = b""
        for byte in data:
            if byte != 0x0A:
                self._line += bytes([byte])
                continue
            line, self._line = self._line.decode("ascii"), b""
            said += self._late + line.encode("ascii") + b"\r\n" + self._answer(line)
            self._late = b""
            if self.splits and said.endswith(b"\x06\r\n"):
                said, self._late = said[:-2], b"\r\n"
        return said if self.garble is None else self.garble(said)

    def _answer(self, line):
        if not self._in_gpascii:
            self._in_gpascii = line == "gpascii -2"
            listens = LISTENS + b"\x06\r\n" * self.acknowledges_start
            return listens if self._in_gpascii else b"sh: not found\r\n" + PROMPT
        self.said.append(line)
        reported = []
        for word in line.split(" "):
            found = next(((match, act) for form, act in ORDERS if (match := re.fullmatch(form, word.lower()))), None)
            if found is None:
                error = f"stdin:{len(self.said)}:{line.index(word)}: error #20: ILLEGAL CMD: {line}\r\n".encode("ascii")
                return error + (b"\x06\r\n" if self.acknowledges_refusals else b"")
            value = found[1](self, found[0])
            if value is not None:
                reported.append(value if self._values_alone else f"{word}={value}")
        return "".join(f"{text}\r\n" for text in reported).encode("ascii") + b"\x06\r\n"

    def echo(self, match):
        self._values_alone = match[1] == "7"

    def element(self, match):
        return str(self.elements[match[0]]) if match[0] in self.elements else "0"

    def motor(self, match):
        index = int(match[1]) - 1
        return {"?": f"${self.motors[index]:016X}", "p": f"{self.positions[index]:.3f}", "f": "0.5"}[match[2]]

    def of_system(self, match):
        return f"${self.system:016X}" if match[1] == "?" else f"{self.override:g}"

    def hold(self, match):
        self.elements["coord[1].feedhold"] = self.elements["coord[1].progrunning"]

    def abort(self, match):
        for name in ("progrunning", "feedhold"):
            self.elements[f"coord[1].{name}"] = 0


ORDERS = (
    (r"echo(\d)", Shell.echo),
    (r"echo", lambda shell, match: None),
    (r"(\d)", Shell.echo),
    (r"cid", lambda shell, match: "604020"),
    (r"(?:coord|motor|sys)[\[\]\w.]+", Shell.element),
    (r"#([1-6])([?pf])", Shell.motor),
    (r"&1([?%])", Shell.of_system),
    (r"&1h", Shell.hold),
    (r"&1a", Shell.abort),
)


class ShellLink:
    """A link to a shell in memory; each ``restart`` is another log-in."""

    def __init__(self, shells, clock):
        self._shells, self._clock = shells, clock
        self._shell, self._coming = None, b""

    def restart(self):
        self._shell = next(self._shells)
        self._coming = self._shell.greeting()

    def read(self, timeout):
        if not self._coming:
            self._clock.now += max(timeout, 1e-3)
        said, self._coming = self._coming[:7], self._coming[7:]  # in pieces that end anywhere
        return said

    def write(self, data):
        self._coming += self._shell.receive(data)

    def close(self):
        self._shell = None
