# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading G-code of Fanuc's controls word by word, as plainly as it can be written, and programs of it made at random.

What the columns of the reader are compared with. Nothing here is shared with it: the text is split by one regular
expression, and the codes of group 01 (motion) and of group 09 (cycles) are two variables, as the manual has them. The
programs are right; no faults are reported.
"""

import math
import random
import re

PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}
PECKING = (73, 83)
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
            if "G65" in line or "G66" in line:
                self.call(line)
                continue
            if self.variables:
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

    def call(self, line):
        """G65 runs a macro; G66 keeps it for the blocks that move."""
        if "G66" in line:
            self.modal = line.replace("G66", "G65")
            return
        words = re.findall(r"([A-Z])([-+]?[\d.]+)", line.replace("G65", ""))
        before, self.variables = self.variables, {}
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
            return str(sum(self.variables.get(int(number), 0.0) for number in re.findall(r"#(\d+)", found[0])))

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
        motion, cycle = codes & {0, 10}, [code // 10 for code in codes if 730 <= code <= 890 and code != 800]
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
            self.move(self.motion, self.target(place))

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
                angle = math.radians(place["XYZ"[second]] / self.scale)
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


def program(seed):
    """A program of moves, cycles, places of the machine, polar coordinates and subprograms; the same for one seed."""
    chance = random.Random(seed)
    inch = chance.random() < 0.15
    plane, axes = chance.choice(((17, "XYZ"), (17, "XYZ"), (18, "ZXY"), (19, "YZX")))

    def number(low, high):
        return f"{chance.uniform(low, high) / (25.4 if inch else 1):.3f}"

    def place(letters, low=-30, high=30):
        chosen = [letter for letter in letters if chance.random() < 0.6] or [letters[0]]
        return " ".join(letter + number(low, high) for letter in chosen)

    def cycle():
        code = chance.choice((73, 81, 82, 83, 85, 89))
        heights = f"{axes[2]}{number(-20, -5)} R{number(-4, 4)}"
        peck = f" Q{number(2, 6)}" if code in PECKING else ""
        if peck and chance.random() < 0.4:
            peck = f" I{number(5, 6)} J{number(0.4, 1.5)} K{number(2, 3)}"
        dwell = f" P{chance.randint(10, 900)}" if code in (82, 89) and chance.random() < 0.7 else ""
        stored = chance.random() < 0.15 and not peck.startswith(" I")
        first = f"G{chance.choice((98, 99))} G{code} {'' if stored else place(axes[:2])} {heights}{peck}{dwell}"
        lines = [first + (chance.choice((" K0", " L0")) if stored else "")]
        for _ in range(chance.randint(0, 4)):
            lines.append(
                chance.choice((place(axes[:2]), f"G{code} {place(axes[:2])}", f"{place(axes[:2])} L2", "G4 P50"))
            )
        if chance.random() < 0.4:  # the words hold for another cycle
            lines.append(f"G{chance.choice((81, 85))} {place(axes[:2])}")
        return [
            *lines,
            *chance.choice((["G80"], ["G80", f"{axes[2]}{number(10, 30)}"], ["G0 G80"], [f"G1 {place('XYZ')}"])),
        ]

    def incremental():
        return ["G91", place("XYZ", -5, 5), f"G0 {place('XYZ', -5, 5)}", "G90"]

    def series():
        top, bottom = number(-40, -30), number(-9, -3)
        hole = f"G91 G99 G81 {place(axes[:2], -5, 5)} {axes[2]}{bottom} R{top} {chance.choice(('K2', '', 'L3'))}"
        return [f"G90 G0 {axes[2]}{number(20, 40)}", hole, place(axes[:2], -5, 5), "G80 G90"]

    def polar():
        turn = f"G0 {axes[0]}{number(5, 30)} {axes[1]}{chance.uniform(-180, 180):.3f}"
        holes = [
            f"G81 {axes[1]}{chance.uniform(-180, 180):.3f} {axes[2]}-9.5 R1.5 P100",
            f"{axes[0]}{number(3, 9)}",
            "G80",
        ]
        return ["G16", turn, *(holes if chance.random() < 0.6 else [turn.replace("G0", "G1")]), "G15"]

    def machine():
        return chance.choice((
            [f"G91 G28 {axes[2]}0", "G90"],
            [f"G0 G28 {place('XYZ')}"],
            ["G28"],
            [f"G30 P2 {place('XYZ')}"],
            [f"G53 {place('XYZ')}"],
            ["G5.1 Q1", f"G1 {place('XYZ')}", "G5.1 Q0"],
            ["G187 P2 E0.01", f"G4 X{chance.randint(1, 9)}.5"],
        ))  # fmt: skip

    def called():
        return ["G91", f"M98 P{chance.choice(('', '2', '3'))}0007", "G90"]

    def scaled():
        centre = " ".join(letter + number(-9, 9) for letter in "XYZ")
        factors = [f"{chance.choice((-1, 1)) * chance.uniform(0.5, 2):.4f}" for _ in "IJK"]
        by = chance.choice((f"P{factors[0]}", " ".join(map("".join, zip("IJK", factors, strict=True)))))
        moves = [f"G{chance.randint(0, 1)} {place('XYZ', -9, 9)}", *incremental()]
        return [f"G51 {centre} {by}", *moves, "G50"]

    def macro():
        arguments = f"{place('XYZ', -9, 9)} I{number(1, 3)} " + chance.choice(("", f"I{number(2, 4)}"))
        if chance.random() < 0.5:
            return [f"G65 P8 {arguments}"]
        return [f"G66 P8 {arguments}", f"G0 {place('XYZ', -9, 9)}", "G4 P20", place("XYZ", -9, 9), "G67"]

    parts = (
        scaled,
        macro,
        cycle,
        cycle,
        incremental,
        series,
        polar,
        machine,
        called,
        lambda: [f"G{chance.randint(0, 1)} {place('XYZ')}"],
    )
    lines = ["O1001", f"G{20 if inch else 21} G0 G{plane} G40 G49 G80 G90 F100 S500 M3", "G0 X1. Y2. Z30."]
    for _ in range(12):
        lines += chance.choice(parts)()
    end = chance.choice(("M30", "M99"))
    return "\n".join([*lines, end, "O7", f"G0 {place('XYZ', -3, 3)}", "M99",
                      "O8", "G0 X#24 Y#25", f"G1 {axes[2]}[#4+#7+#26]", "M99", ""])  # fmt: skip
