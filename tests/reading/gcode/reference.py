# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading G-code block by block, as plainly as it can be written: what the columns of the reader are compared with.

Knows G0 to G3, G4, G10 L2, G17 to G21, G40 to G42.1, G43, G43.5, G49, G52, G54 to G56, G61, G61.1, G64, G68, G69,
G51.1, G50.1, G81, G90 to G95, G98, G99, T, M6, M3 to M9, S, F. Its programs are right; it reports no faults.
"""

import numpy as np

PLANE_AXES = {170: (0, 1, 2), 180: (2, 0, 1), 190: (1, 2, 0)}


def shift(vector):
    matrix = np.eye(4)
    matrix[:3, 3] = vector
    return matrix


def turn(first, second, degrees):
    matrix = np.eye(4)
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -sine, sine
    return matrix


class Machine:
    """The state of the machine, and what it did."""

    def __init__(self, tools):
        self.tools = tools
        self.mode = dict(motion=0, plane=170, unit=1.0, relative=False, absolute_centre=False, feed=940, retract=980)
        self.here = np.zeros(3)
        self.system, self.origins, self.angles = 540, {}, {}
        self.local = np.zeros(3)
        self.about = np.eye(4)
        self.mirrors = {}
        self.length = None
        self.selected = self.tool = None
        self.side = 0.0
        self.speed = self.sense = self.f = 0.0
        self.axis = np.array([0.0, 0.0, 1.0])  # in {C}: a frame turns the coordinates, not the tool
        self.exact, self.tolerance = 640, 0.0
        self.cycle, self.level = {}, None
        self.rows, self.events = [], []

    def matrix(self):
        mirror = np.eye(4)
        for coordinate, value in self.mirrors.items():
            mirror[coordinate, coordinate], mirror[coordinate, 3] = -1.0, 2 * value
        longer = 0.0 if self.length is None else self.length - self.tools[self.tool].length
        work = shift(self.origins.get(self.system, np.zeros(3))) @ turn(0, 1, self.angles.get(self.system, 0.0))
        return shift([0, 0, longer]) @ work @ shift(self.local) @ self.about @ mirror

    def reframe(self, change):
        place = self.matrix() @ [*self.here, 1]
        change()
        self.here = (np.linalg.inv(self.matrix()) @ place)[:3]

    def block(self, line, words, g, m):
        scale = 25.4 if 200 in g else 1.0 if 210 in g else self.mode["unit"]
        self.modes(g, scale)
        if {610, 611, 640} & set(g):
            self.tolerance = words.get("P", 0.0) * scale if 640 in g else 0.0
        if "F" in words:
            self.f = words["F"] if self.mode["feed"] == 930 else words["F"] * scale
        self.switch(words, m)
        if 40 in g:
            self.events.append((len(self.rows), 4, words["P"]))
        xyz = [words[letter] * scale if letter in words else None for letter in "XYZ"]
        self.frames(words, g, xyz)
        if any(code in g for code in (680, 511, 501, 100, 520, 920)):
            return
        vector = [words.get(letter, words.get(f"T{axis}")) for letter, axis in zip("IJK", "XYZ", strict=True)]
        turning = self.mode["motion"] in (0, 10) and vector[0] is not None
        if turning:
            self.axis = self.matrix()[:3, :3] @ (np.array(vector) / np.sqrt(sum(value**2 for value in vector)))
        arc = self.mode["motion"] in (20, 30) and any(letter in words for letter in "IJKR")
        if any(value is not None for value in xyz) or turning or arc:
            self.move(line, words, scale, xyz)

    def modes(self, g, scale):
        self.mode["unit"] = scale
        for code in g:
            if code in (0, 10, 20, 30, 810, 800):
                if code != self.mode["motion"]:
                    self.cycle, self.level = {}, None
                self.mode["motion"] = code
            elif code in PLANE_AXES:
                self.mode["plane"] = code
            elif code in (900, 910):
                self.mode["relative"] = code == 910
            elif code in (901, 911):
                self.mode["absolute_centre"] = code == 901
            elif code in (930, 940, 950):
                self.mode["feed"] = code
            elif code in (980, 990):
                self.mode["retract"] = code
            elif code in (610, 611, 640):
                self.exact = code

    def switch(self, words, m):
        self.selected = words.get("T", self.selected)
        if 6 in m:
            self.tool, self.sense = int(self.selected), 0.0  # stopped until M3 or M4 [NGC 3.6.3]
            self.events.append((len(self.rows), 1, self.tool))
        before = self.speed * self.sense
        self.speed = words.get("S", self.speed)
        for code in m:
            self.sense = {3: 1.0, 4: -1.0, 5: 0.0}.get(code, self.sense)
        if {3, 4, 5} & set(m) or before != self.speed * self.sense:
            self.events.append((len(self.rows), 2, self.speed * self.sense))
        for code in m:
            if code in (7, 8, 9):
                self.events.append((len(self.rows), 3, {7: 2, 8: 1, 9: 0}[code]))

    def frames(self, words, g, xyz):
        said = {coordinate: value for coordinate, value in enumerate(xyz) if value is not None}
        for code in g:
            if code == 430:
                self.reframe(lambda: setattr(self, "length", self.tools[int(words["H"])].length))
            elif code == 490:
                self.reframe(lambda: setattr(self, "length", None))
            elif code in (540, 550, 560):
                self.reframe(lambda code=code: setattr(self, "system", code))
            elif code == 680:
                self.reframe(lambda: setattr(self, "about", self.rotation(words["R"], xyz)))
            elif code == 690:
                self.reframe(lambda: setattr(self, "about", np.eye(4)))
            elif code == 511:
                self.reframe(lambda: self.mirrors.update(said))
            elif code == 501:
                self.reframe(self.mirrors.clear)
            elif code == 100:
                self.reframe(lambda: self.origin(540 + 10 * (int(words["P"]) - 1), said, words.get("R")))
            elif code == 520:
                self.reframe(lambda: self.set_local(said))
            elif code == 920:
                self.call_here(said)
            elif code == 400:
                self.side = 0.0
            elif code in (411, 421):
                self.side = words["D"] * self.mode["unit"] / 2 * (1 if code == 411 else -1)

    def rotation(self, degrees, xyz):
        first, second, _ = PLANE_AXES[self.mode["plane"]]
        centre = np.array([value or 0.0 for value in xyz])
        return shift(centre) @ turn(first, second, degrees) @ shift(-centre)

    def origin(self, system, said, degrees):
        origin = self.origins.get(system, np.zeros(3)).copy()
        for coordinate, value in said.items():
            origin[coordinate] = value
        self.origins[system] = origin
        if degrees is not None:
            self.angles[system] = degrees

    def set_local(self, said):
        self.local = np.array([said.get(coordinate, self.local[coordinate]) for coordinate in range(3)])

    def call_here(self, said):
        wanted = np.array([said.get(coordinate, self.here[coordinate]) for coordinate in range(3)])
        rest = np.linalg.inv(shift(self.local)) @ self.work_inverse() @ self.matrix()
        self.local = self.local + (rest @ [*self.here, 1] - rest @ [*wanted, 1])[:3]
        self.here = wanted

    def work_inverse(self):
        longer = 0.0 if self.length is None else self.length - self.tools[self.tool].length
        work = shift(self.origins.get(self.system, np.zeros(3))) @ turn(0, 1, self.angles.get(self.system, 0.0))
        return np.linalg.inv(shift([0, 0, longer]) @ work)

    def target(self, xyz):
        end = self.here.copy()
        for coordinate, value in enumerate(xyz):
            if value is not None:
                end[coordinate] = end[coordinate] + value if self.mode["relative"] else value
        return end

    def move(self, line, words, scale, xyz):
        motion = self.mode["motion"]
        if motion == 810:
            self.drill(line, words, scale, xyz)
        elif motion in (20, 30):
            self.arc(line, words, scale, self.target(xyz))
        else:
            self.row(line, motion // 10, self.target(xyz), words)

    def drill(self, line, words, scale, xyz):
        first, second, normal = PLANE_AXES[self.mode["plane"]]
        if "R" in words:
            self.cycle["R"] = words["R"] * scale
        if xyz[normal] is not None:
            self.cycle["bottom"] = xyz[normal]
        height = self.here[normal]
        self.level = height if self.level is None else self.level
        top = self.cycle["R"] + (self.level if self.mode["relative"] else 0)
        bottom = self.cycle["bottom"] + (top if self.mode["relative"] else 0)
        clear = max(self.level, top) if self.mode["retract"] == 980 else top
        stops = [(0, normal, height if height > top else clear)]
        for _ in range(int(words.get("L", 1))):
            stops += [(0, (first, second), xyz), (0, normal, top), (1, normal, bottom), (0, normal, clear)]
        for kind, coordinate, value in stops:
            end = self.here.copy()
            if coordinate == normal:
                end[normal] = value
            else:
                over = self.target([None if axis == normal else word for axis, word in enumerate(xyz)])
                end[first], end[second] = over[first], over[second]
            if not np.array_equal(end, self.here):
                self.row(line, kind, end, words)

    def arc(self, line, words, scale, end):
        first, second, normal = PLANE_AXES[self.mode["plane"]]
        clockwise = self.mode["motion"] == 20
        start, centre = self.here.copy(), self.here.copy()
        if "R" in words:
            radius = words["R"] * scale
            chord = np.array([end[first] - start[first], end[second] - start[second]])
            height = np.sqrt(max(radius**2 - chord @ chord / 4, 0.0))
            left = np.array([-chord[1], chord[0]]) / np.sqrt(chord @ chord)
            height = -height if clockwise == (radius > 0) else height
            centre[[first, second]] = start[[first, second]] + chord / 2 + height * left
        else:
            for coordinate in (first, second):
                word = words.get("IJK"[coordinate], 0.0) * scale
                centre[coordinate] = word if self.mode["absolute_centre"] else start[coordinate] + word
        axis = np.zeros(3)
        axis[normal] = -1.0 if clockwise else 1.0
        angles = [np.arctan2(p[second] - centre[second], p[first] - centre[first]) for p in (start, end)]
        sweep = (angles[0] - angles[1] if clockwise else angles[1] - angles[0]) % (2 * np.pi)
        sweep = sweep + 2 * np.pi if sweep < 1e-9 else sweep
        turns = int(words.get("P", 1))
        total = sweep + 2 * np.pi * (turns - 1)
        radius = np.hypot(start[first] - centre[first], start[second] - centre[second])
        pieces = [start + (end - start) * np.eye(3)[normal] * (2 * np.pi * k / total) for k in range(1, turns)]
        way = np.hypot(radius * total, end[normal] - start[normal])
        for piece in [*pieces, end]:
            centre = centre.copy()
            self.row(line, 2, piece, words, centre, axis, way)
            centre[normal] = piece[normal]

    def row(self, line, kind, end, words, centre=None, axis=None, way=None):
        matrix = self.matrix()
        way = np.linalg.norm(end - self.here) if way is None else way
        feed = {930: self.f * way, 940: self.f, 950: self.f * self.speed}[self.mode["feed"]] / 60
        hand = np.sign(np.linalg.det(matrix[:3, :3]))
        normal = matrix[:3, :3] @ np.eye(3)[PLANE_AXES[self.mode["plane"]][2]]
        plane = int(np.argmax(np.abs(normal)))
        surface = np.array([words.get(name, np.nan) for name in ("NX", "NY", "NZ")])
        self.rows.append(dict(
            line=line,
            kind=kind,
            position=(matrix @ [*end, 1])[:3],
            tool_axis=self.axis,
            feed=feed if kind else np.nan,
            arc_centre=np.full(3, np.nan) if centre is None else (matrix @ [*centre, 1])[:3],
            arc_axis=np.full(3, np.nan) if axis is None else hand * matrix[:3, :3] @ axis,
            exact_stop=self.exact == 611,
            exact_path=self.exact == 610 or self.mode["motion"] == 810,  # LinuxCNC: cycles in exact path mode
            tip_tolerance=0.0 if self.mode["motion"] == 810 else self.tolerance,
            side_offset=self.side * hand * np.sign(normal[plane]),
            plane=plane,
            normal=matrix[:3, :3] @ surface / np.sqrt(surface @ surface),
        ))  # fmt: skip
        self.here = np.array(end, dtype=float)


def resolve_by_block(blocks, tools):
    """The rows of the program, a dictionary each, and its events as (row, kind, value)."""
    machine = Machine(tools)
    for row in range(len(blocks)):
        machine.block(int(blocks.line[row]), blocks.words_of(row), blocks.g_of(row).tolist(), blocks.m_of(row).tolist())
    return machine.rows, machine.events
