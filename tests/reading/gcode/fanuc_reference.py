# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading G-code of Fanuc's controls word by word, as plainly as it can be written.

What the columns of the reader are compared with. Nothing here is shared with it: the text is split by one regular
expression, and the codes of group 01 (motion) and of group 09 (cycles) are two variables, as the manual has them. The
programs are right; no faults are reported.
"""

import math
import operator
import re

PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
PECKING = (73, 83)
COMMON = 100
"""Variables from here on are not local to a macro."""
COMPARED = {"EQ": operator.eq, "NE": operator.ne, "LT": operator.lt, "LE": operator.le, "GT": operator.gt,
            "GE": operator.ge}  # fmt: skip
BACK = 0.254
"""mm by which G73 goes back and G83 stops before the depth reached."""


class Control:
    """The state of a control, and what it did: rows [kind, x, y, z] with 0 rapid and 1 line, and [4, seconds]."""

    def __init__(self, text, zero):
        self.lines = [line.split("(")[0].strip() for line in text.splitlines()]
        self.zero, self.rows = zero, []
        self.here, self.motion, self.cycle, self.words = [math.nan] * 3, 0, None, {}
        self.level = self.plane = None
        self.scale, self.relative, self.plane, self.returns, self.polar = 1.0, False, 17, True, False
        self.centre, self.factor = [0.0] * 3, [1.0] * 3
        self.variables, self.modal = {}, None
        self.run(0)

    def run(self, at):
        """Blocks from a line on, until M30 or M99."""
        while True:
            line, at = self.lines[at], at + 1
            if (to := self.flow(line, at)) is not None:
                at = to
                continue
            if "G65" in line or "G66" in line:
                self.call(line)
                continue
            if "#" in line:
                line = self.substituted(line)
            words = [(letter, float(value)) for letter, value in re.findall(r"([A-Z])([-+]?[\d.]+)", line)]
            codes = {round(10 * value) for letter, value in words if letter == "G"}
            ends = {int(value) for letter, value in words if letter == "M"}
            given = {letter: value for letter, value in words if letter not in "GM"}
            if 98 in ends:
                count, number = divmod(int(given["P"]), 10000)
                for _ in range(max(count, 1)):
                    self.run(self.lines.index(f"O{number}") + 1)
            elif ends & {30, 99}:
                return
            elif "O" not in given:
                self.block(codes, given)
                if 670 in codes:
                    self.modal = None
                elif self.modal and set(given) & set("XYZ"):
                    modal, self.modal = self.modal, None
                    self.call(modal)
                    self.modal = modal

    def flow(self, line, at):
        """The row behind an assignment, a jump or a loop, None for another block; ``at`` is the row behind it."""
        if found := re.match(r"#(\d+)=(.*)", line):
            self.variables[int(found[1])] = self.value(found[2])
            return at
        if found := re.match(r"IF \[(.*)\] GOTO (\d+)", line):
            places = [row for row, text in enumerate(self.lines) if text.startswith(f"N{found[2]} ")]
            return min(row for row in places if row >= at) if self.holds(found[1]) else at
        if found := re.match(r"WHILE \[(.*)\] DO(\d)", line):
            return at if self.holds(found[1]) else self.lines.index(f"END{found[2]}", at) + 1
        if line.startswith("END"):
            begins = [row for row, text in enumerate(self.lines[:at]) if text.endswith(f"] DO{line[3]}")]
            return begins[-1]
        return None

    def holds(self, condition):
        left, sign, right = condition.split()
        return COMPARED[sign](self.value(left), self.value(right))

    def value(self, text):
        """The sum of products of numbers and variables in brackets or without."""
        factors = [term.split("*") for term in text.strip("[]").split("+")]
        return sum(math.prod(map(self.operand, each)) for each in factors)

    def operand(self, text):
        return self.variables.get(int(text[1:]), 0.0) if text.startswith("#") else float(text)

    def call(self, line):
        """G65 runs a macro; G66 keeps it for the blocks that move."""
        if "G66" in line:
            self.modal = line.replace("G66", "G65")
            return
        words = re.findall(r"([A-Z])([-+]?[\d.]+)", line.replace("G65", ""))
        common = {number: value for number, value in self.variables.items() if number >= COMMON}
        before, self.variables = self.variables, common
        sets = 0
        for letter, value in words:
            if letter == "I":
                self.variables[4 + 3 * sets] = float(value)
                sets += 1
            elif letter in "XYZ":
                self.variables["XYZ".index(letter) + 24] = float(value)
        number = next(value for letter, value in words if letter == "P")
        self.variables[0] = 0.0
        self.run(self.lines.index(f"O{number}") + 1)
        self.variables = before

    def substituted(self, line):
        """A line with values in place of variables, and without words of vacant ones."""

        def total(found):
            return f"{self.value(found[0]):.9f}"

        def word(found):
            value = self.variables.get(int(found[2]))
            return "" if value is None else f"{found[1]}{value:.9f}"

        return re.sub(r"([A-Z])#(\d+)", word, re.sub(r"\[[^]]*\]", total, line))

    def block(self, codes, words):
        for code, (name, value) in MODES.items():
            if code in codes:
                setattr(self, name, value)
        if codes & {51, 1870}:
            return
        if 510 in codes:
            self.centre = [words.get(letter, 0.0) * self.scale for letter in "XYZ"]
            self.factor = [words.get("P", words.get(letter, 1.0)) for letter in "IJK"]
            return
        if 500 in codes:
            self.factor = [1.0] * 3
            return
        if 40 in codes:
            self.rows.append([4, words["X"] if "X" in words else words["P"] / 1000])
            return
        motion, cycle = codes & {0, 10, 20, 30}, [code // 10 for code in codes if 730 <= code <= 890 and code != 800]
        if motion or 800 in codes or cycle:
            self.motion = min(motion) // 10 if motion else self.motion
            was = self.cycle
            self.cycle = cycle[0] if cycle else None
            if self.cycle is None or was is None:
                self.words, self.level = {}, None
        place = {letter: words[letter] * self.scale for letter in "XYZ" if letter in words}
        if codes & {280, 300}:
            self.home(place)
        elif 530 in codes:
            self.move(0, [self.zero[i] + place[c] if c in place else self.here[i] for i, c in enumerate("XYZ")])
        elif self.cycle and (place or cycle):
            self.drill(place, {letter: value * self.scale for letter, value in words.items() if letter in "RQ"}, words)
        elif place:
            self.move(min(self.motion, 2), self.target(place))

    def home(self, place):
        if place:
            self.move(0, self.target(place, turn=False))
        self.move(0, [self.zero[i] if not place or c in place else self.here[i] for i, c in enumerate("XYZ")])

    def target(self, place, turn=True):
        start = self.here if self.relative else [0.0] * 3
        for i, c in enumerate("XYZ"):
            if c in place and self.factor[i] != 1:
                from_centre = place[c] if self.relative else place[c] - self.centre[i]
                place = place | {c: self.factor[i] * from_centre + (0 if self.relative else self.centre[i])}
        end = [start[i] + place[c] if c in place else self.here[i] for i, c in enumerate("XYZ")]
        first, second, _ = PLANES[self.plane]
        if self.polar and turn and ("XYZ"[first] in place or "XYZ"[second] in place):
            radius, angle = (
                math.hypot(self.here[first], self.here[second]),
                math.atan2(self.here[second], self.here[first]),
            )
            radius = place.get("XYZ"[first], radius)
            if "XYZ"[second] in place:
                angle = math.radians(place["XYZ"[second]] / self.scale) + (angle if self.relative else 0.0)
            end[first], end[second] = radius * math.cos(angle), radius * math.sin(angle)
        return end

    def drill(self, place, more, words):
        first, second, normal = PLANES[self.plane]
        self.level = self.here[normal] if self.level is None else self.level
        across = {letter: value for letter, value in place.items() if letter != "XYZ"[normal]}
        self.words.update(more)
        if "XYZ"[normal] in place:
            self.words["depth"] = place["XYZ"[normal]]
        if "P" in words:
            self.words["dwell"] = words["P"] / 1000
        if "I" in words:
            self.words["pecks"] = [words[letter] * self.scale for letter in "IJK"]
            self.words["Q"] = self.words["pecks"][0]
        elif "Q" in words:
            self.words.pop("pecks", None)
        times = int(words.get("L", words.get("K", 1) if "I" not in words else 1))
        top = self.words["R"] + (self.level if self.relative else 0)
        bottom = self.words["depth"] + (top if self.relative else 0)
        clear = max(self.level, top) if self.returns else top
        if times and self.here[normal] <= top:
            self.along(0, normal, clear)
        for _ in range(times):
            over = self.target(across)
            over[normal] = self.here[normal]
            self.move(0, over)
            self.along(0, normal, top)
            self.hole(normal, top, bottom, clear)

    def hole(self, normal, top, bottom, clear):
        depth, peck = top, self.words.get("Q")
        while self.cycle in PECKING and depth - peck > bottom:
            depth -= peck
            self.along(1, normal, depth)
            if self.cycle == 83:
                self.along(0, normal, top)
            self.along(0, normal, depth + BACK)
            if "pecks" in self.words:
                peck = max(peck - self.words["pecks"][1], min(peck, self.words["pecks"][2]))
        self.along(1, normal, bottom)
        if self.cycle in (82, 89) and self.words.get("dwell"):
            self.rows.append([4, self.words["dwell"]])
        if self.cycle in (85, 89):
            self.along(1, normal, top)
        self.along(0, normal, clear)

    def along(self, kind, axis, to):
        end = list(self.here)
        end[axis] = to
        self.move(kind, end)

    def move(self, kind, end):
        if end != self.here and not any(map(math.isnan, end)):
            self.rows.append([kind, *end])
        self.here = list(end)


MODES = {
    **{10 * plane: ("plane", plane) for plane in PLANES},
    200: ("scale", 25.4),
    210: ("scale", 1.0),
    900: ("relative", False),
    910: ("relative", True),
    980: ("returns", True),
    990: ("returns", False),
    150: ("polar", False),
    160: ("polar", True),
}
"""Attribute and value by code, in tenths."""
