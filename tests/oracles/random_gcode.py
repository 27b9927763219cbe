# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs of G-code made at random: moves, arcs, cycles and offsets, as rs274 takes them.

Enters a seed. Leaves the text; the same for the same seed, whatever Python runs it.
"""

import random

import numpy as np

PLANES = (("G17", "XYZ", "IJ"), ("G18", "ZXY", "KI"), ("G19", "YZX", "JK"))
"""For each plane: first axis, second axis, axis across; and the words of the centre."""
CYCLES = ("G73", "G81", "G82", "G83", "G85", "G86", "G89")
PECKS = {"G73": " Q2.5", "G83": " Q3.1", "G81": "", "G85": ""}
HOLES = (("G17", "Z", "XY"), ("G18", "Y", "XZ"), ("G19", "X", "YZ"))
UNITS = 25


def program(seed):
    """A program of moves, arcs, cycles and offsets in a fixed order of chance."""
    return _Maker(random.Random(seed)).text()


class _Maker:
    def __init__(self, chance):
        self.chance = chance
        # When an angle is set with G10 L2 while G92 is in force, rs274 loses the place of the tool.
        self.local = chance.random() < 0.5
        self.choices = (
            self.move,
            self.feed_moves,
            self.incremental,
            self.inches,
            self.arc,
            self.arc,
            self.cycle,
            self.inverse_time,
            self.local_offset,
            self.end_of_local_offset,
            self.work_offset,
            self.work_offset_here,
            self.coordinate_system,
            self.length_offset,
            self.machine_coordinates,
            self.home,
        )

    def text(self):
        lines = ["G21 G90 G94 G17 G40 G49 G54 G98 F300 S1000 M3", "G0 X1 Y2 Z30"]
        for _ in range(UNITS):
            lines += self.chance.choice(self.choices)()
        return "\n".join([*(f"N{n} {line}" for n, line in enumerate(lines, 1)), "M2", ""])

    def number(self, low, high):
        return f"{self.chance.uniform(low, high):.3f}"

    def words(self, letters, low=-30, high=30):
        chosen = [letter for letter in letters if self.chance.random() < 0.6] or [letters[0]]
        return " ".join(letter + self.number(low, high) for letter in chosen)

    def move(self):
        return [f"{self.chance.choice(('G0', 'G1'))} {self.words('XYZ')}"]

    def feed_moves(self):
        return [f"G1 {self.words('XYZ')} F{self.number(50, 900)}", self.words("XYZ"), self.words("XYZ")]

    def incremental(self):
        return ["G91", f"G1 {self.words('XYZ', -5, 5)}", self.words("XYZ", -5, 5), "G90"]

    def inches(self):
        return ["G20", f"G1 {self.words('XYZ', -1, 1)} F{self.number(5, 30)}", f"X{self.number(-1, 1)}", "G21"]

    def arc(self):
        plane, (first, second, third), centre_words = self.chance.choice(PLANES)
        sense = self.chance.choice(("G2", "G3"))
        helix = f" {third}{self.number(-3, 3)}" if self.chance.random() < 0.5 else ""
        words = self.radius_words if self.chance.random() < 0.4 else self.centre_words
        return [f"{plane} G91", sense + words(first, second, helix, centre_words), "G90 G17"]

    def radius_words(self, first, second, helix, _):
        dx, dy = self.chance.uniform(-9, 9), self.chance.uniform(-9, 9)
        radius = self.chance.choice((-1, 1)) * (np.hypot(dx, dy) / 2 + self.chance.uniform(0.01, 9))
        return f" {first}{dx:.3f} {second}{dy:.3f}{helix} R{radius:.3f}"

    def centre_words(self, first, second, helix, centre_words):
        i, j = centre_words
        radius, begin, end = self.chance.uniform(1, 9), self.chance.uniform(0, 6), self.chance.uniform(0, 6)
        ends = [radius * (np.cos(end) - np.cos(begin)), radius * (np.sin(end) - np.sin(begin))]
        turns = self.chance.choice(("", "", " P2", " P3"))
        is_full = self.chance.random() < 0.2
        to = "" if is_full else f" {first}{ends[0]:.4f} {second}{ends[1]:.4f}"
        return f"{to}{helix} {i}{-radius * np.cos(begin):.4f} {j}{-radius * np.sin(begin):.4f}{turns}"

    def cycle(self):
        code = self.chance.choice(CYCLES)
        extra = PECKS.get(code, " P0.5")
        plane, depth, across = self.chance.choice(HOLES)
        height = self.chance.choice(("G98", "G99"))
        block = f"{plane} {height} {code} {self.words(across)} {depth}-9.2 R{self.number(-5, 8)}{extra}"
        out = [block + self.chance.choice(("", " L2")), self.words(across)]
        out += [f"{self.words(across)} {depth}-11", "G80 G17"]
        if self.chance.random() < 0.3:
            holes = f"{self.words(across)} {depth}-{self.number(5, 9)} R-{self.number(0, 3)}{extra}"
            out = [f"{plane} G91 {code} {holes} L3", "G80 G90 G17"]
        return out

    def inverse_time(self):
        return [f"G93 G1 {self.words('XYZ')} F{self.number(1, 9)}", f"G94 F{self.number(100, 900)}"]

    def local_offset(self):
        return [f"{self.chance.choice(('G92', 'G52'))} {self.words('XYZ')}" if self.local else "G92.1"]

    def end_of_local_offset(self):
        return [self.chance.choice(("G92.1", "G92.2", "G92.3"))]

    def work_offset(self):
        number, words = self.chance.randint(1, 3), self.words("XYZ")
        turn = "" if self.local else f" R{self.number(-60, 60)}"
        return [f"G10 L2 P{number} {words}{turn}"]

    def work_offset_here(self):
        return [f"G10 L20 P{self.chance.randint(0, 3)} {self.words('XYZ')}"]

    def coordinate_system(self):
        return [self.chance.choice(("G54", "G55", "G56", "G59.3"))]

    def length_offset(self):
        return [self.chance.choice(("G43 H1", "G43 H2", "G43.2 H3", "G49", f"G43.1 Z{self.number(0, 9)}"))]

    def machine_coordinates(self):
        code = self.chance.choice(("G0", "G1"))
        return [f"G53 {code} X{self.number(-9, 9)} Y{self.number(-9, 9)} Z{self.number(0, 9)}"]

    def home(self):
        return [self.chance.choice(("G28", "G28 Z5", "G28.1", "G30", "G30 X1 Y2", "G30.1"))]
