# SPDX-License-Identifier: LGPL-2.1-or-later
"""What rs274, the interpreter of LinuxCNC, makes of a program.

rs274 (Debian: linuxcnc-uspace) says the moves in program coordinates and in the program's units; here they are taken to
machine coordinates in mm: local offset, rotation, work offset, length offset.
"""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

INCH = 25.4
LENGTHS = {1: 10.0, 2: 25.5, 3: 40.0}
"""Length offsets of the tools by number, mm; a tool's diameter is its number."""
CALL = re.compile(r"^\s*\d+ N(\S+)\s+(\w+)\((.*)\)\s*$")
AXES = {"XY": (0, 1, 2), "YZ": (1, 2, 0), "XZ": (2, 0, 1)}
MOVES = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED")


def rs274(text):
    """Points in mm, (n, 3), with the kind (0 rapid, 1 line, 2 arc), feed in mm/min and arc centre of each, or None."""
    output = output_of(text)
    return None if output is None else moves(output)


def output_of(text):
    """What rs274 prints of a program, None where it refuses it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "part.ngc").write_text(text)
        (path / "var").write_text("")
        # The table is in inches whatever the machine is.
        rows = [f"T{n} P{n} Z{length / INCH:.9f} D{n / INCH:.9f} ;\n" for n, length in LENGTHS.items()]
        (path / "tools").write_text("".join(rows))
        command = ["rs274", "-t", path / "tools", "-v", path / "var", "-g", path / "part.ngc"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    return run.stdout if run.returncode == 0 else None


def moves(output):
    """The moves in the output of rs274, without those that stay in place."""
    machine, found = Machine(), []
    for line in output.splitlines():
        match = CALL.match(line)
        if match:
            _, name, text = match.groups()
            if name in MOVES:
                found.append(machine.move(name, numbers(text)))
            else:
                machine.set(name, text)
    return found


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+\.\d+|-?\d+", text)]


class Machine:
    """What is in force."""

    def __init__(self):
        self.local, self.origin, self.tool = np.zeros(3), np.zeros(3), np.zeros(3)
        self.angle, self.scale, self.axes, self.feed = 0.0, 1.0, AXES["XY"], 0.0

    def set(self, name, text):
        if name == "USE_LENGTH_UNITS":
            self.scale = INCH if "INCHES" in text else 1.0
        elif name == "SELECT_PLANE":
            self.axes = AXES[text.split("_")[-1]]
        elif name == "SET_G92_OFFSET":
            self.local = np.array(numbers(text)[:3]) * self.scale
        elif name == "SET_G5X_OFFSET":
            self.origin = np.array(numbers(text)[1:4]) * self.scale
        elif name == "SET_XY_ROTATION":
            self.angle = np.radians(numbers(text)[0])
        elif name == "USE_TOOL_LENGTH_OFFSET":
            self.tool = np.array(numbers(text)[:3]) * self.scale
        elif name == "SET_FEED_RATE":
            self.feed = numbers(text)[0] * self.scale

    def shifted(self, name, text, point):
        """Another call, and the coordinates that a point of the program has after it."""
        place = self.place(point * self.scale)
        self.set(name, text)
        return self.turn().T @ (place - self.origin - self.tool) / self.scale - self.local / self.scale

    def move(self, name, values):
        """Kind, place, feed and, of an arc, centre, axis and turns."""
        kind, arc = MOVES.index(name), None
        point = np.array(values[:3]) * self.scale
        if name == "ARC_FEED":
            point, arc = self.arc(values)
        return kind, self.place(point).tolist(), None if kind == 0 else self.feed, arc

    def arc(self, values):
        first, second, centre_first, centre_second, turns, third = values[:6]
        axes, point, middle, across = list(self.axes), np.zeros(3), np.zeros(3), np.zeros(3)
        point[axes] = first * self.scale, second * self.scale, third * self.scale
        middle[axes] = centre_first * self.scale, centre_second * self.scale, third * self.scale
        across[axes[2]] = np.sign(turns)
        return point, [self.place(middle).tolist(), (self.turn() @ across).tolist(), abs(int(turns))]

    def turn(self):
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        return np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])

    def place(self, point):
        return self.turn() @ (point + self.local) + self.origin + self.tool
