# SPDX-License-Identifier: LGPL-2.1-or-later
"""Series of canned cycles made at random: programs of G-code that drill, as rs274 takes them.

Enters a seed. Leaves the text; the same for the same seed, whatever Python runs it. A series goes on with other holes,
depths, R planes, cycles, repeats and ways to retract, under G90 and G91, and is broken off by other motion. Some
programs have a fault in one of their cycles.

Left out is what rs274 does not do as its own manual has it: in a series begun below R it goes down to R over the hole
that is done, from a higher R or from the reference point; and it takes the numbers in force for others after G20, G21
or another plane. Where its manual leaves open what a program means, after a change between G90 and G91, R and the depth
are written again.
"""

import random

PLANES = (("G17", "XYZ"), ("G17", "XYZ"), ("G18", "ZXY"), ("G19", "YZX"))
MORE = {"G73": "Q", "G81": "", "G82": "P", "G83": "Q", "G85": "", "G86": "P", "G89": "P"}
OF_CAM = ("G73", "G81", "G82", "G83", "G85", "G89")
FAULTY = 0.06
"""Part of the series that have a fault."""


def program(seed):
    """Some series of cycles, one after the other."""
    return _Maker(random.Random(seed)).text()


def cam_program(seed):
    """The same as CAM operations have it: mm, G90, G17, without L."""
    return _Maker(random.Random(seed), in_cam=True).text()


class _Maker:
    def __init__(self, chance, in_cam=False):
        self.chance, self.in_cam = chance, in_cam
        self.inch = not in_cam and chance.random() < 0.15
        self.low, self.turned = chance.random() < 0.1, False
        self.plane, axes = PLANES[0] if in_cam else chance.choice(PLANES)
        self.first, self.second, self.normal = axes
        self.relative, self.returns = False, True
        self.height = self.level = self.top = self.bottom = 0.0
        self.code = ""

    def text(self):
        lines = self.head()
        for _ in range(self.chance.randint(1, 3)):
            lines += self.series()
        return "\n".join([*lines, "M2", ""])

    def head(self):
        if self.in_cam:
            return [self.start()]
        modes = f"{'G20' if self.inch else 'G21'} G90 G94 {self.plane} G40 G49 G54 G98"
        frame = self.chance.choice(("", "", f"G92 {self.place(-9, 9)}", f"G10 L2 P1 {self.place(-9, 9)} R30"))
        self.turned = frame.endswith("R30")
        return [modes, "F300 S1000 M3", *filter(None, [frame]), self.start()]

    def start(self):
        self.height = self.chance.uniform(-20, -15) if self.low else self.chance.uniform(10, 40)
        self.height = round(self.height, 1)
        return f"G0 {self.first}{self.number(0, 9)} {self.second}{self.number(0, 9)}\nG0 {self.said(self.height)}"

    def number(self, low, high):
        return self.written(self.chance.uniform(low, high))

    def written(self, value):
        return f"{value / 25.4:.3f}" if self.inch else f"{value:.1f}"

    def said(self, height):
        return self.normal + self.written(height)

    def place(self, low, high):
        return " ".join(letter + self.number(low, high) for letter in "XYZ")

    def across(self):
        """Words of one or both coordinates of the plane, or none."""
        letters = self.chance.choice((self.first, self.second, self.first + self.second, self.first + self.second, ""))
        low, high = (-6, 6) if self.relative else (0, 40)
        return "".join(f" {letter}{self.number(low, high)}" for letter in letters)

    def series(self):
        self.level = self.height
        lines = [self.begin()]
        for _ in range(self.chance.randint(1, 6)):
            lines.append(self.chance.choice(self.ways())())
        if self.chance.random() < FAULTY:
            lines.append(self.faulty())
        return [line for line in lines if line] + self.end()

    def ways(self):
        ways = [self.hole, self.hole, self.hole, self.other_depth, self.other_retract, self.other_cycle]
        ways += [] if self.low else [self.other_top, self.other_top]
        return ways if self.in_cam else [*ways, self.repeated, self.other_distances, self.beside]

    def begin(self):
        self.code = self.chance.choice(OF_CAM if self.in_cam else tuple(MORE))
        if not self.in_cam and self.chance.random() < 0.4:
            self.relative = True
        return f"{self.retract()}{self.distances()} {self.code}{self.across()}{self.heights()}{self.more()}"

    def retract(self):
        """G98, G99 or nothing; CAM wants codes in commands of their own."""
        code = self.chance.choice(("G98", "G99", "G99", ""))
        self.returns = self.returns if not code else code == "G98"
        return code + "\n" * bool(code and self.in_cam)

    def distances(self):
        return "" if self.in_cam else " G91" if self.relative else " G90"

    def heights(self):
        """Depth and R, new ones."""
        highest = -9 if self.low else min(self.level - 1, 9)
        if not (self.low and self.top):
            self.top = round(self.chance.uniform(highest - 12, highest), 1)
        return self.top_word() + self.bottom_word()

    def top_word(self):
        return f" R{self.written(self.top - self.level if self.relative else self.top)}"

    def bottom_word(self):
        self.bottom = round(self.top - self.chance.uniform(0, 9), 1)
        return f" {self.said(self.bottom - self.top if self.relative else self.bottom)}"

    def more(self):
        letter = MORE[self.code]
        if letter == "Q":
            return f" Q{self.number(1.5, 6)}"
        return f" P{self.chance.choice(('0.5', '0.25', '1'))}" if letter else ""

    def named(self, words):
        """A block of the series; CAM repeats the code."""
        return f"{self.code}{words}" if self.in_cam or self.chance.random() < 0.3 else words.strip()

    def moving(self):
        return self.across() or f" {self.first}{self.number(0, 5)}"

    def hole(self):
        return self.named(self.moving())

    def other_depth(self):
        return self.named(self.moving() + self.bottom_word())

    def other_top(self):
        return self.named(self.moving() + self.heights())

    def other_retract(self):
        return self.retract() + ("" if self.in_cam else " ") + self.named(self.moving())

    def other_cycle(self):
        self.code = self.chance.choice(OF_CAM if self.in_cam else tuple(MORE))
        return f"{self.code}{self.across()}{self.heights()}{self.more()}"

    def repeated(self):
        return self.named(f"{self.moving()} L{self.chance.randint(1, 3)}")

    def other_distances(self):
        self.relative = not self.relative
        return f"{self.distances().strip()} {self.code}{self.across()}{self.heights()}"

    def beside(self):
        """What leaves words and levels as they are, the way to the reference point among it."""
        home = f"G28 {self.said(9)}\n{self.hole()}"
        local = f"G92 {self.first}{self.number(0, 9)}"
        return self.chance.choice(("M8", "S900", "G4 P0.5", "G61", local, "F250" if self.low or self.turned else home))

    def faulty(self):
        """A cycle that rs274 refuses."""
        code = self.code
        return self.chance.choice((
            f"G80\n{code} {self.first}5",
            f"G0 {self.first}5\n{code} {self.first}6 {self.normal}-50",
            f"{code} {self.first}5 {self.said(99)} R-9",
            f"G83 {self.first}5 {self.normal}-50 R-40 Q0",
            "G80\nG82 R-40 " + self.said(-50),
        ))  # fmt: skip

    def end(self):
        """Other motion, at some other height."""
        lines = [self.chance.choice(("G80", "") if self.in_cam else ("G80", "", "G0 G80", "G80 G1"))]
        lines += [] if self.in_cam else ["G90"]
        self.relative = False
        self.height = max(self.level, self.top) if self.returns else self.top
        move = self.chance.choice(("G0", "G1"))
        feed = " F5" if self.in_cam and move == "G1" else ""
        lines += [f"{move} {self.first}{self.number(0, 9)}{feed}"]
        if self.chance.random() < 0.7:
            lines += [self.start()]
        return [line for line in lines if line]
