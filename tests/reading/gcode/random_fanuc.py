# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs for Fanuc's controls made at random: moves, arcs, cycles, places of the machine, scaling, macros and jumps.

Enters a seed. Leaves the text; the same for the same seed.
"""

import random

from fanuc_reference import PECKING

PLANES = ((17, "XYZ"), (17, "XYZ"), (18, "ZXY"), (19, "YZX"))
PARTS = 16
SUBPROGRAMS = ("O7", "G0 {}", "M99", "O8", "G0 X#24 Y#25", "G1 {}[#4+#7+#26]", "M99", "")


def program(seed):
    """A program; the same for one seed."""
    return _Maker(random.Random(seed)).text()


class _Maker:
    """Writes one program. Each part is a list of blocks that leave G90, G0 or G1 and no cycle in force."""

    def __init__(self, chance):
        self.chance, self.label = chance, 100
        self.inch = chance.random() < 0.15
        self.plane, self.axes = chance.choice(PLANES)

    def text(self):
        lines = [
            "O1001",
            f"G{20 if self.inch else 21} G0 G{self.plane} G40 G49 G80 G90 F100 S500 M3",
            "G0 X1. Y2. Z30.",
        ]
        parts = (
            self.scaled, self.macro, self.cycle, self.cycle, self.incremental, self.series, self.polar, self.machine,
            self.called, self.moves, self.arc, self.loop, self.jump,
        )  # fmt: skip
        for _ in range(PARTS):
            lines += self.chance.choice(parts)()
        called, macro = self.place("XYZ", -3, 3), self.axes[2]
        ends = [line.format(called if line.startswith("G0 {") else macro) for line in SUBPROGRAMS]
        return "\n".join([*lines, self.chance.choice(("M30", "M99")), *ends])

    def number(self, low, high):
        return f"{self.chance.uniform(low, high) / (25.4 if self.inch else 1):.3f}"

    def place(self, letters, low=-30, high=30):
        chosen = [letter for letter in letters if self.chance.random() < 0.6] or [letters[0]]
        return " ".join(letter + self.number(low, high) for letter in chosen)

    def moves(self):
        return [f"G{self.chance.randint(0, 1)} {self.place('XYZ')}"]

    def arc(self):
        """An arc by its radius, from wherever the tool is; a helix at times."""
        first, second, normal = self.axes
        long = self.chance.choice(("", "-"))
        rise = f" {normal}{self.number(-2, 2)}" if self.chance.random() < 0.4 else ""
        ends = f"{first}{self.number(1, 4)} {second}{self.number(-4, 4)}{rise}"
        return [f"G91 G{self.chance.choice((2, 3))} {ends} R{long}{self.number(4, 9)}", f"G90 G1 {self.place('XYZ')}"]

    def loop(self):
        """Holes in a row, or a way in steps, by a variable that is counted."""
        step, last = self.number(0.5, 3), self.chance.randint(0, 3)
        return [
            "#101=0",
            f"WHILE [#101 LT {last}] DO1",
            f"G1 {self.axes[0]}[#101*{step}] {self.axes[1]}{self.number(-9, 9)}",
            "#101=[#101+1]",
            "END1",
        ]

    def jump(self):
        """A block that a condition leaves out or not."""
        self.label += 1
        sign = self.chance.choice(("EQ", "NE", "LT", "LE", "GT", "GE"))
        condition = f"#102={self.chance.randint(0, 2)}", f"IF [#102 {sign} 1] GOTO {self.label}"
        return [*condition, *self.moves(), f"N{self.label} G0 {self.place('XYZ')}"]

    def cycle(self):
        """A cycle and further holes; at times another cycle, which takes over its words."""
        code, across = self.chance.choice((73, 81, 82, 83, 85, 89)), self.axes[:2]
        words, may_store = self._words_of(code)
        stored = may_store and self.chance.random() < 0.15
        first = f"G{self.chance.choice((98, 99))} G{code} {'' if stored else self.place(across)} {words}"
        lines = [first + (self.chance.choice((" K0", " L0")) if stored else "")]
        for _ in range(self.chance.randint(0, 4)):
            hole = self.place(across)
            lines.append(self.chance.choice((hole, f"G{code} {hole}", f"{hole} L2", "G4 P50")))
        if self.chance.random() < 0.4:
            lines.append(f"G{self.chance.choice((81, 85))} {self.place(across)}")
        ends = (["G80"], ["G80", f"{self.axes[2]}{self.number(10, 30)}"], ["G0 G80"], [f"G1 {self.place('XYZ')}"])
        return [*lines, *self.chance.choice(ends)]

    def _words_of(self, code):
        """Depth, R, pecks and dwell of a cycle, and whether it may be stored by K0."""
        heights = f"{self.axes[2]}{self.number(-20, -5)} R{self.number(-4, 4)}"
        peck, may_store = f" Q{self.number(2, 6)}" if code in PECKING else "", True
        if peck and self.chance.random() < 0.4:
            peck, may_store = f" I{self.number(5, 6)} J{self.number(0.4, 1.5)} K{self.number(2, 3)}", False
        dwell = f" P{self.chance.randint(10, 900)}" if code in (82, 89) and self.chance.random() < 0.7 else ""
        return f"{heights}{peck}{dwell}", may_store

    def incremental(self):
        return ["G91", self.place("XYZ", -5, 5), f"G0 {self.place('XYZ', -5, 5)}", "G90"]

    def series(self):
        """Holes of a cycle in increments."""
        across, normal = self.axes[:2], self.axes[2]
        count = self.chance.choice(("K2", "", "L3"))
        depths = f"{normal}{self.number(-9, -3)} R{self.number(-40, -30)}"
        hole = f"G91 G99 G81 {self.place(across, -5, 5)} {depths} {count}"
        return [f"G90 G0 {normal}{self.number(20, 40)}", hole, self.place(across, -5, 5), "G80 G90"]

    def polar(self):
        first, second, normal = self.axes

        def angle():
            return f"{second}{self.chance.uniform(-180, 180):.3f}"

        turn = f"G0 {first}{self.number(5, 30)} {angle()}"
        holes = [f"G81 {angle()} {normal}-9.5 R1.5 P100", f"{first}{self.number(3, 9)}", "G80"]
        moves = [turn.replace("G0", "G1"), f"G91 {second}40.5", f"{second}-75", "G90"]
        more = holes if self.chance.random() < 0.6 else moves
        return ["G16", turn, *more, "G15"]

    def machine(self):
        """Places of the machine, requests for smoothing, and dwells."""
        place = self.place("XYZ")
        return self.chance.choice((
            [f"G91 G28 {self.axes[2]}0", "G90"],
            [f"G0 G28 {place}"],
            ["G28"],
            [f"G30 P2 {place}"],
            [f"G53 {place}"],
            ["G5.1 Q1", f"G1 {place}", "G5.1 Q0"],
            ["G187 P2 E0.01", f"G4 X{self.chance.randint(1, 9)}.5"],
        ))  # fmt: skip

    def called(self):
        return ["G91", f"M98 P{self.chance.choice(('', '2', '3'))}0007", "G90"]

    def scaled(self):
        """Moves between G51 and G50, with one factor or three, mirrored at times."""
        centre = " ".join(letter + self.number(-9, 9) for letter in "XYZ")
        factors = [f"{self.chance.choice((-1, 1)) * self.chance.uniform(0.5, 2):.4f}" for _ in "IJK"]
        by = self.chance.choice((f"P{factors[0]}", " ".join(map("".join, zip("IJK", factors, strict=True)))))
        moves = [f"G{self.chance.randint(0, 1)} {self.place('XYZ', -9, 9)}", *self.incremental()]
        return [f"G51 {centre} {by}", *moves, "G50"]

    def macro(self):
        """A macro, once or behind each block that moves."""
        again = self.chance.choice(("", f"I{self.number(2, 4)}"))
        arguments = f"{self.place('XYZ', -9, 9)} I{self.number(1, 3)} {again}"
        if self.chance.random() < 0.5:
            return [f"G65 P8 {arguments}"]
        moves = [f"G0 {self.place('XYZ', -9, 9)}", "G4 P20", self.place("XYZ", -9, 9)]
        return [f"G66 P8 {arguments}", *moves, "G67"]
