# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random programs in Siemens's language: this reader and a second one, which shares no code with it, agree."""

import random

import numpy as np
import pytest
from second_reader import Second
from series import cases

from pkm_post.model import Kind, Tool
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.siemens import read

PROGRAMS = cases(120)
TOOL = Tool(0, "", 10.0, 0.0, 100.0)


class Writer:
    """Writes one random program."""

    def __init__(self, seed):
        self.choose = random.Random(seed)
        self.lines = ["G90 G17 G71 G94 G54 F600", "G0 X1 Y2 Z3", "TRAORI", "R1=1 R2=2.5 R3=-3"]
        self.is_scaled = False
        self.labels = 0

    def number(self):
        return f"{self.choose.uniform(-20, 20):.3f}"

    def value(self):
        """A number or an expression."""
        kind = self.choose.random()
        if kind < 0.6:
            return self.number()
        a, b = (self.choose.choice(("R1", "R2", "R3", self.number().lstrip("-"))) for _ in range(2))
        return self.choose.choice((
            f"{a}+{b}", f"{a}-{b}*2", f"({a}+{b})/4", f"SIN({a})*{b}", f"POT({a})-{b}", f"SQRT(ABS({a}))", f"-{a}",
            f"TRUNC({a})+ATAN2({b},2)", f"COS({a}+{b})",
        ))  # fmt: skip

    def word(self, name):
        kind = self.choose.random()
        if kind < 0.5:
            return name + self.number()
        if kind < 0.8:
            return f"{name}={self.value()}"
        return f"{name}={self.choose.choice(('AC', 'IC'))}({self.value()})"

    def axis(self):
        if self.choose.random() < 0.8:
            return ""
        words = [f"A3={self.choose.uniform(-1, 1):.4f}", f"B3={self.choose.uniform(-1, 1):.4f}"]
        return " " + " ".join(self.choose.sample(words, self.choose.randint(0, 2)) + ["C3=1"])

    def move(self):
        names = self.choose.sample("XYZ", self.choose.randint(1, 3))
        code = self.choose.choice(("", "G0 ", "G1 "))
        feed = f" F{self.choose.randint(100, 900)}" if self.choose.random() < 0.3 else ""
        # behind an arc G0 or G1 has to stand
        if not code and any(word in self.lines[-1] for word in ("G2", "G3")):
            code = "G1 "
        self.lines.append(code + " ".join(map(self.word, names)) + self.axis() + feed)

    def arc(self):
        """An arc from where the tool is: full circles, and those by radius, fit whatever the start."""
        plane = self.choose.choice((17, 18, 19))
        first, second = {17: "XY", 18: "ZX", 19: "YZ"}[plane]
        letter = "IJK"["XYZ".index(first)]
        code = self.choose.choice(("G2", "G3"))
        radius = self.choose.uniform(1, 9)
        kind = self.choose.random()
        if kind < 0.4:
            words = f"{letter}{radius:.3f}"
        elif kind < 0.7:  # half a circle about a centre beside the start
            words = f"{first}=IC({2 * radius:.3f}) {letter}{radius:.3f}"
        else:
            sign = self.choose.choice(("", "-"))
            words = f"{first}=IC({radius:.3f}) {second}=IC(0.5) CR={sign}{radius * 0.8:.3f}"
        self.lines.append(f"G{plane} {code} {words}")
        self.lines.append("G1 G17")

    def frame(self):
        add = self.choose.choice(("", "A"))
        kind = self.choose.choice(("TRANS", "ROT", "MIRROR", "SCALE"))
        names = self.choose.sample("XYZ", self.choose.randint(1, 2))
        if kind == "SCALE":
            # even, so that circles remain circles
            self.lines.append(f"{add}SCALE X1.5 Y1.5 Z1.5")
        elif kind == "MIRROR":
            self.lines.append(f"{add}MIRROR {names[0]}0")
        elif kind == "ROT" and self.choose.random() < 0.4:
            self.lines.append(f"{add}ROT RPL={self.number()}")
        else:
            self.lines.append(f"{add}{kind} " + " ".join(f"{name}={self.value()}" for name in names))

    def modal(self):
        self.lines.append(
            self.choose.choice(("G90", "G91", "G70", "G71", "G700 F9", "G710 F300", "FFWON", "G642", "; X1"))
        )

    def flow(self, depth=0):
        kind = self.choose.randrange(3)
        self.labels += 1
        if kind == 0:
            counter = 10 + depth
            self.lines.append(f"FOR R{counter}=1 TO {self.choose.randint(0, 3)}")
            self.body(depth)
            self.lines.append("ENDFOR")
        elif kind == 1:
            sign = self.choose.choice(("<", ">", "==", "<>", "<=", ">="))
            self.lines.append(f"IF R1{sign}{self.choose.randint(0, 2)}")
            self.body(depth)
            if self.choose.random() < 0.5:
                self.lines.append("ELSE")
                self.body(depth)
            self.lines.append("ENDIF")
        else:
            self.lines.append(f"IF (R1>{self.choose.randint(0, 2)}) AND (R2<3) GOTOF LABEL{self.labels}")
            label = self.labels
            self.body(depth)
            self.lines.append(f"LABEL{label}: R1=R1+1")

    def body(self, depth):
        for _ in range(self.choose.randint(1, 3)):
            self.item(depth + 1)

    def item(self, depth=0):
        kind = self.choose.random()
        if kind < 0.6 or depth > 2:
            self.move()
        elif kind < 0.72:
            self.arc()
        elif kind < 0.8:
            self.frame()
        elif kind < 0.88:
            self.modal()
        elif kind < 0.93:
            self.lines.append(f"R{self.choose.randint(1, 3)}={self.value()}")
        else:
            self.flow(depth)

    def text(self):
        """The program."""
        for _ in range(self.choose.randint(3, 14)):
            self.item()
        return "\n".join([*self.lines, "M30"])


def columns_of(rows):
    """The rows of the second reader as columns of a program."""
    nowhere = (np.nan,) * 3
    return {
        "kind": [min(row.code, 2) for row in rows],
        "position": [row.point for row in rows],
        "tool_axis": [row.axis for row in rows],
        "feed": [np.nan if row.feed is None else row.feed / 60 for row in rows],
        "arc_centre": [row.centre or nowhere for row in rows],
        "arc_axis": [row.normal or nowhere for row in rows],
    }


@pytest.mark.slow
def test_random_programs_are_read_alike(monkeypatch):
    """On a control that goes by the distances alone after a new frame (setting data 42440)."""
    monkeypatch.setattr("pkm_post.reading.siemens.motions._SHIFTED", np.inf)
    arcs = moves = 0
    for seed in range(PROGRAMS):
        text = Writer(seed).text()
        expected = Second(text.split("\n")).run()
        program, diagnostics = read(text, "part.mpf", ReadOptions(default_tool=TOOL, needs_end=True))
        assert program is not None, f"seed {seed}\n{text}\n" + "\n".join(map(str, diagnostics))
        assert len(program) == len(expected), f"seed {seed}\n{text}"
        for name, wanted in columns_of(expected).items():
            found = getattr(program, name)
            assert np.allclose(found, wanted, rtol=1e-9, atol=1e-7, equal_nan=True), f"seed {seed}, {name}\n{text}"
        arcs += int((program.kind == Kind.ARC).sum())
        moves += len(program)
    assert moves > 7 * PROGRAMS
    assert arcs > PROGRAMS / 2
