# SPDX-License-Identifier: LGPL-2.1-or-later
"""A second reader of Siemens's language, by the manuals and apart from the first: block by block, in scalars.

It shares no code with ``pkm_post.reading.siemens``: Python computes the expressions, frames are functions from points
to points, and a program is a list of lines with a counter. It takes right programs only.
"""

import math
import re
from dataclasses import dataclass, field

WORD = re.compile(r"([A-Z]+\d*)=((?:AC|IC|DC)\(.*?\)(?=\s|$)|\S+)|([A-Z])([-+]?[\d.]+)|([A-Z_]{2,}\w*(?:\(.*\))?)")
DEGREES = 180 / math.pi
NAMES = {
    "SIN": lambda x: math.sin(x / DEGREES), "COS": lambda x: math.cos(x / DEGREES), "SQRT": math.sqrt, "ABS": abs,
    "POT": lambda x: x * x, "TRUNC": math.trunc, "ATAN2": lambda y, x: math.atan2(y, x) * DEGREES,
}  # fmt: skip


@dataclass
class Row:
    """One motion: G code, end point, tool axis, feed in mm/min, centre and sense of an arc."""

    code: int
    point: tuple
    axis: tuple
    feed: float | None = None
    centre: tuple | None = None
    normal: tuple | None = None


@dataclass
class Second:
    """The state of a run."""

    lines: list
    r: dict = field(default_factory=dict)
    rows: list = field(default_factory=list)
    frame: list = field(default_factory=list)
    at: dict = field(default_factory=lambda: dict.fromkeys("XYZ", 0.0))
    axis: tuple = (0.0, 0.0, 1.0)
    code: int = 0
    plane: int = 17
    relative: bool = False
    unit: float = 1.0
    feed_unit: float = 1.0
    feed: float = 0.0

    def run(self):
        """Carry out all lines up to M30."""
        row, stack = 0, []
        while row < len(self.lines):
            text = self.lines[row].split(";")[0].strip()
            text = re.sub(r"^N\d+\s*", "", text)
            label = re.match(r"(\w\w+):\s*(.*)", text)
            text = label[2] if label else text
            row = self.flow(text, row, stack)
            if row < 0:
                return self.rows
        return self.rows

    def flow(self, text, row, stack):
        """Carry out a line; the next one, or -1 at the end."""
        if text.startswith("M30"):
            return -1
        if found := re.match(r"FOR R(\d+)=(\S+) TO (\S+)", text):
            number = int(found[1])
            self.r[number] = self.value(found[2])
            stack.append((row, number, self.value(found[3])))
            return row + 1 if self.r[number] <= stack[-1][2] else self.skip(row, "FOR ", "ENDFOR", stack)
        if text == "ENDFOR":
            begin, number, last = stack[-1]
            self.r[number] += 1
            if self.r[number] <= last:
                return begin + 1
            stack.pop()
            return row + 1
        if found := re.match(r"IF (.*?) GOTO([FB]) (\w+)", text):
            if not self.value(found[1]):
                return row + 1
            places = [k for k, line in enumerate(self.lines) if re.match(rf"(N\d+\s*)?{found[3]}:", line)]
            return min(k for k in places if k > row) if found[2] == "F" else max(k for k in places if k < row)
        if found := re.match(r"IF (.*)", text):
            return row + 1 if self.value(found[1]) else self.branch(row, ("ELSE", "ENDIF"))
        if text == "ELSE":
            return self.branch(row, ("ENDIF",))
        if text != "ENDIF":
            self.block(text)
        return row + 1

    def skip(self, row, begin, end, stack):
        stack.pop()
        depth = 0
        while True:
            row += 1
            depth += self.lines[row].startswith(begin)
            if self.lines[row] == end:
                if not depth:
                    return row + 1
                depth -= 1

    def branch(self, row, ends):
        depth = 0
        while True:
            row += 1
            line = self.lines[row]
            if not depth and line in ends:
                return row + 1
            depth += bool(re.match(r"IF (?!.*GOTO)", line)) - (line == "ENDIF")

    def value(self, text):
        """An expression, by Python: R1 is r[1], <> is != and so on."""
        text = re.sub(r"\bR(\d+)", r"r[\1]", text).replace("<>", "!=")
        text = text.replace(" DIV ", " // ").replace(" MOD ", " % ").replace("AND", "and").replace("OR", "or")
        return eval(text, {"__builtins__": {}}, {"r": self.r, **NAMES})

    def block(self, text):
        """One block of words, or a frame statement."""
        frame = re.match(r"(A?)(TRANS|ROT|SCALE|MIRROR)\b(.*)", text)
        if frame:
            self.set_frame(frame[1], frame[2], frame[3])
            return
        words, names = {}, []
        for name, value, letter, number, alone in WORD.findall(text):
            if name.startswith("R") and name[1:].isdigit():
                self.r[int(name[1:])] = self.value(value)
            elif alone:
                names.append(alone)
            elif letter == "G":
                self.g_code(int(number))
            else:
                words[name or letter] = value or number
        for name in names:
            if name in ("CIP", "CT"):
                self.code = name
        if "F" in words:
            self.feed = self.value(words["F"]) * self.feed_unit
        if any(name in words for name in ("X", "Y", "Z", "I", "J", "K", "A3", "B3", "C3", "CR")):
            self.move(words)

    def g_code(self, code):
        if code in (0, 1, 2, 3):
            self.code = code
        elif code in (17, 18, 19):
            self.plane = code
        elif code in (90, 91):
            self.relative = code == 91
        elif code in (70, 71):
            self.unit = 25.4 if code == 70 else 1.0
        elif code in (700, 710):
            self.unit = self.feed_unit = 25.4 if code == 700 else 1.0

    def coordinate(self, name, text, here, relative):
        found = re.fullmatch(r"(AC|IC)\((.*)\)", text)
        if found:
            relative, text = found[1] == "IC", found[2]
        return self.value(text) * self.unit + (here if relative else 0.0)

    def move(self, words):
        start = dict(self.at)
        for name in "XYZ":
            if name in words:
                self.at[name] = self.coordinate(name, words[name], start[name], self.relative)
        vector = [self.value(words[name]) if name in words else 0.0 for name in ("A3", "B3", "C3")]
        if any(name in words for name in ("A3", "B3", "C3")):
            self.axis = unit(self.directed(vector))
        row = Row(self.code, self.placed(self.at), self.axis, None if self.code == 0 else self.feed)
        if self.code in (2, 3):
            row.centre, row.normal = self.arc(words, start)
        self.rows.append(row)

    def arc(self, words, start):
        """Centre and axis in {C}, by complex numbers in the plane."""
        first, second, third = {17: "XYZ", 18: "ZXY", 19: "YZX"}[self.plane]
        here, there = complex(start[first], start[second]), complex(self.at[first], self.at[second])
        sense = -1 if self.code == 2 else 1
        if "CR" in words:
            radius = self.value(words["CR"]) * self.unit
            chord = there - here
            height = math.sqrt(max(radius**2 - abs(chord) ** 2 / 4, 0.0))
            middle = here + chord / 2 + sense * math.copysign(height, radius) * 1j * chord / abs(chord)
        else:
            offset = [0.0, 0.0]
            for k, name in enumerate((first, second)):
                letter = "IJK"["XYZ".index(name)]
                if letter in words:
                    offset[k] = self.coordinate(letter, words[letter], start[name], True) - start[name]
            middle = here + complex(*offset)
        centre = {first: middle.real, second: middle.imag, third: start[third]}
        normal = {first: 0.0, second: 0.0, third: float(sense)}
        turned = self.directed([normal[name] for name in "XYZ"])
        return self.placed(centre), tuple(self.hand() * value for value in turned)

    # frames: a list of steps, each from point to point, the last one nearest to the program

    def set_frame(self, additive, kind, text):
        words = {name or letter: value or number for name, value, letter, number, _ in WORD.findall(text)}
        step = (kind, {name: self.value(value) for name, value in words.items()}, self.unit, self.plane)
        place = self.placed(self.at)
        self.frame = [*self.frame, step] if additive else [step]
        self.at = dict(zip("XYZ", self.back(place), strict=True))

    def placed(self, at):
        point = [at[name] for name in "XYZ"]
        for step in reversed(self.frame):
            point = applied(step, point, True)
        return tuple(point)

    def directed(self, vector):
        for step in reversed(self.frame):
            if step[0] in ("ROT", "MIRROR"):
                vector = applied(step, vector, True)
        return tuple(vector)

    def hand(self):
        return math.prod(-1 for step in self.frame if step[0] == "MIRROR" for name in step[1])

    def back(self, point):
        point = list(point)
        for step in self.frame:
            point = applied(step, point, False)
        return point


def applied(step, point, forward):
    """A step of a frame applied to a point, or taken back."""
    kind, words, length, plane = step
    point = list(point)
    if kind == "TRANS":
        sign = length if forward else -length
        return [value + sign * words.get(name, 0.0) for value, name in zip(point, "XYZ", strict=True)]
    if kind == "SCALE":
        factors = [words.get(name, 1.0) for name in "XYZ"]
        return [value * factor if forward else value / factor for value, factor in zip(point, factors, strict=True)]
    if kind == "MIRROR":
        return [-value if name in words else value for value, name in zip(point, "XYZ", strict=True)]
    if "RPL" in words:
        turns = [({17: 2, 18: 1, 19: 0}[plane], words["RPL"])]
    else:
        turns = [(k, words[name]) for k, name in ((0, "X"), (1, "Y"), (2, "Z")) if name in words]
    for k, angle in turns if forward else reversed(turns):
        i, j = (k + 1) % 3, (k + 2) % 3
        turned = complex(point[i], point[j]) * complex(math.cos(angle / DEGREES), math.sin(angle / DEGREES)) ** (
            1 if forward else -1
        )
        point[i], point[j] = turned.real, turned.imag
    return point


def unit(vector):
    """A vector of length 1."""
    length = math.sqrt(sum(value * value for value in vector))
    return tuple(value / length for value in vector)
