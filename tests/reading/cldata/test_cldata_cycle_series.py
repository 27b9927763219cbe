# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random series of cycles: the moves are those of a second reader, and no rapid move is lower than its holes need."""

import numpy as np
import pytest
from cycles_by_hand import BACK_ABOVE_BOTTOM, ByHand, without_standing_still
from series import cases

from pkm_post.model import Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading import gcode
from pkm_post.reading.cldata import ReadOptions, read

NANOMETRE = 1e-6
PROGRAMS = cases(60)
MAKERS = {"nx": "nx", "creo": "creo", "solidworks": "solidworks", "apt": "nccs"}


class Writer:
    """Writes a program with cycles as one CAM system does: words change on the way, cycles go off and on."""

    def __init__(self, dialect, seed):
        self.dialect, self.random = dialect, np.random.default_rng(seed)
        self.base = self.axis_near(np.array([0, 0, 1.0]), 0.5)
        self.tilts = self.random.random() < 0.6

    def axis_near(self, axis, spread):
        near = axis + self.random.uniform(-spread, spread, 3)
        return near / np.linalg.norm(near)

    def text(self):
        self.lines = ["LOADTL/1", f"UNITS/{self.random.choice(['MM', 'MM', 'INCHES'])}", "FEDRAT/100,MMPM"]
        self.motion()
        for _ in range(self.random.integers(1, 6)):
            self.lines.append(self.cycle())
            self.holes()
            if self.random.random() < 0.4:
                self.lines.append("CYCLE/OFF")
                self.between()
        return "\n".join(self.lines) + "\nCYCLE/OFF\n"

    def between(self):
        """Something else while the cycle is off, and perhaps the same cycle again."""
        for _ in range(self.random.integers(0, 3)):
            self.motion()
        if self.random.random() < 0.5:
            self.lines.append("CYCLE/ON")
            self.holes()

    def motion(self):
        if self.random.random() < 0.6:
            self.lines.append("RAPID")
        self.lines.append(self.goto(self.number(-20, 60)))

    def holes(self):
        self.lines += [self.goto(self.number(-20, 20)) for _ in range(self.random.integers(1, 5))]

    def goto(self, z):
        axis = self.axis_near(self.base, 0.3) if self.tilts else self.base
        with_axis = not self.said_axis or self.tilts and self.random.random() < 0.7
        self.said_axis = True
        words = [self.number(-50, 50), self.number(-50, 50), z, *(map(repr, axis.tolist()) if with_axis else [])]
        return "GOTO/" + ",".join(words)

    said_axis = False

    def number(self, low, high):
        return f"{self.random.uniform(low, high):.3f}"

    def cycle(self):
        write = {"nx": self.nx, "creo": self.creo, "solidworks": self.camworks, "apt": self.nccs}[self.dialect]
        kind, pairs = write()
        pairs += [("MMPM", self.number(50, 500))] if self.random.random() < 0.7 else []
        order = self.random.permutation(len(pairs))
        return ",".join([f"CYCLE/{kind}", *(",".join(pairs[index]) for index in order)])

    def some(self, *choices):
        return choices[self.random.integers(len(choices))]

    def step(self):
        return self.number(2, 8)

    def nx(self):
        kind = self.some("DRILL", "DRILL,DEEP", "DRILL,BRKCHP", "DRILL,CSINK", "BORE")
        back = self.some(
            [], [("RTRCTO", "AUTO")], [("RTRCTO", self.number(0, 30))], [("RTRCTO", self.number(0, 9), "MANUAL")]
        )
        step = [("STEP", self.step())] if kind in ("DRILL,DEEP", "DRILL,BRKCHP") else []
        return kind, [("FEDTO", self.number(-20, -1)), (self.some("RAPTO", "CLEAR"), self.number(0, 6)), *back, *step]

    def creo(self):
        kind = self.some("DRILL", "FACE", "CSINK", "DEEP", "BRKCHP", "REAM")
        back = self.some([], [("RETURN", "0")], [("RETURN", self.number(1, 30))])
        advance = self.some([], [("RAPTO", self.number(0, 3))])
        step = [("STEP", self.step())] if kind in ("DEEP", "BRKCHP") else []
        return kind, [("DEPTH", self.number(1, 20)), ("CLEAR", self.number(3, 9)), *advance, *back, *step]

    def camworks(self):
        if self.random.random() < 0.5:
            self.lines.append(f"CYCLE/{self.some('INIT', 'CLEAR')}")
        kind = self.some("DRILL", "DEEP", "DEEP2")
        back = self.some([], [("RTRCTO", self.number(0, 30))])
        peck = {
            "DRILL": [("DWELL", "0")], "DEEP": [("INCR", self.step())],
            "DEEP2": [("1STPECK", self.number(4, 9)), ("SUBPECK", self.step())],
        }[kind]  # fmt: skip
        return kind, [("FEDTO", self.number(1, 20)), ("RAPTO", self.number(0, 6)), *back, *peck]

    def nccs(self):
        back = self.some([], [("RTRCTO", self.number(0, 30))])
        kind = self.some("DRILL", "FACE", "REAM")
        return kind, [("FEDTO", self.number(1, 20)), ("RAPTO", self.number(0, 6)), *back]


def programs(dialect):
    """Programs of a dialect, each with its text, the reader by hand, and what the product makes of it."""
    for seed in range(PROGRAMS):
        text = Writer(dialect, [seed, len(dialect)]).text()
        program, diagnostics = read(text, "part.cl", ReadOptions(dialect=dialect))
        assert not errors(diagnostics), text + "\n".join(map(str, diagnostics))
        yield text, ByHand(MAKERS[dialect], text), program


@pytest.mark.slow
@pytest.mark.parametrize("dialect", MAKERS)
def test_moves_are_those_of_the_reader_by_hand(dialect):
    for text, by_hand, program in programs(dialect):
        expected = without_standing_still(by_hand.moves)
        moved = np.abs(np.diff(np.hstack([program.position, program.tool_axis]), axis=0)).max(axis=1) > 1e-7
        rows = np.flatnonzero(np.concatenate([[True], moved]))
        assert program.line[rows].tolist() == [move.line for move in expected], text
        assert program.position[rows] == pytest.approx(np.array([move.place for move in expected]), abs=NANOMETRE)
        assert program.tool_axis[rows] == pytest.approx(np.array([move.axis for move in expected]), abs=1e-9)
        rapid = np.array([move.feed is None for move in expected])
        assert (program.kind[rows] == Kind.RAPID).tolist() == rapid.tolist()
        feeds = [move.feed for move in expected if move.feed is not None]
        assert program.feed[rows][~rapid] * 60 == pytest.approx(np.array(feeds))


def height(places, hole):
    """How high places are above the clearance of a hole, along its axis."""
    return (places - hole.point) @ hole.axis - hole.clear


@pytest.mark.slow
@pytest.mark.parametrize("dialect", MAKERS)
def test_no_rapid_move_goes_sideways_below_what_its_holes_need(dialect):
    crossings = 0
    for text, by_hand, program in programs(dialect):
        place, axis, share = program.position, program.tool_axis, np.linspace(0, 1, 11)[:, None]
        last = None
        for hole in by_hand.holes:
            rows = np.flatnonzero(program.line == hole.line)
            for row in rows[program.kind[rows] == Kind.RAPID].tolist():
                way = place[row] - place[row - 1]
                along = min(np.linalg.norm(np.cross(way, k)) for k in (axis[row - 1], axis[row]))
                if along < NANOMETRE:
                    continue
                line = place[row - 1] + share * way
                needs = [hole, last] if last is not None and last.line == program.line[rows[0] - 1] else [hole]
                assert min(height(line, need).min() for need in needs) > -NANOMETRE, text
                crossings += len(needs)
            last = hole
    assert crossings > PROGRAMS


@pytest.mark.slow
@pytest.mark.parametrize("dialect", MAKERS)
def test_every_hole_is_reached_at_its_depth_and_cut_at_the_feed(dialect):
    for text, by_hand, program in programs(dialect):
        for hole in by_hand.holes:
            rows = np.flatnonzero(program.line == hole.line)
            offset = program.position[rows] - hole.point
            depth = -offset @ hole.axis
            cutting = program.kind[rows] == Kind.LINE
            bottom = rows[cutting][np.argmax(depth[cutting])]
            assert program.position[bottom] == pytest.approx(hole.point - hole.depth * hole.axis, abs=NANOMETRE), text
            assert depth.max() == pytest.approx(hole.depth, abs=NANOMETRE)
            cut = np.maximum.accumulate(np.where(cutting, depth, -np.inf))[:-1]
            down = (np.diff(depth) > NANOMETRE) & ~cutting[1:] & (depth[1:] > NANOMETRE)
            assert (depth[1:][down] <= cut[down] - BACK_ABOVE_BOTTOM + NANOMETRE).all(), text


def tips(program):
    """Where the tip goes, standing still left out."""
    moved = np.abs(np.diff(program.position, axis=0)).max(axis=1) > 1e-9
    return program.position[np.concatenate([[True], moved])]


@pytest.mark.slow
def test_upright_series_are_those_of_canned_cycles():
    """RTRCTO,AUTO is G98 and no RTRCTO G99; tests/reading/gcode compares series of G-code with rs274."""
    random = np.random.default_rng(98)
    for _ in range(100):
        back = random.choice(["", ",RTRCTO,AUTO"])
        cl = ["UNITS/MM", "RAPID", "GOTO/0,0,10,0,0,1"]
        nc = ["G21 G90 G17 G94", "G0 X0 Y0 Z10", "G98" if back else "G99"]
        for x, y, z, clear, depth in random.integers(1, 25, (random.integers(1, 7), 5)).tolist():
            cl += [f"CYCLE/DRILL,RAPTO,{clear},FEDTO,{-depth},MMPM,100{back}", f"GOTO/{x},{y},{z}"]
            nc += [f"G81 X{x} Y{y} R{z + clear} Z{z - depth} F100"]
        drilled, diagnostics = read("\n".join(cl), "part.cls", ReadOptions(dialect="nx"))
        assert not errors(diagnostics)
        canned, diagnostics = gcode.read("\n".join([*nc, "G80", "M2"]), "part.ngc")
        assert not errors(diagnostics)
        assert tips(drilled) == pytest.approx(tips(canned), abs=NANOMETRE), cl


CYCLE_ITEMS = [
    "DRILL", "DEEP", "BRKCHP", "DEEP2", "BORE", "REAM", "FACE", "CSINK", "TAP", "INIT", "CLEAR", "ON", "OFF", "FEDTO",
    "DEPTH", "RAPTO", "RTRCTO", "RETURN", "AUTO", "MANUAL", "STEP", "INCR", "SUBPECK", "1STPECK", "DWELL", "REV",
    "MMPM", "IPR", "INVERS", "TWIST", "", "0", "-3", "5", "5", "2.5", "1e9", "-1e-9", "(POINT/1,2)", "N=4", "'a'",
]  # fmt: skip
SOUND_CYCLES = ["DRILL,FEDTO,-9,RAPTO,2", "DRILL,DEPTH,9,CLEAR,5,RAPTO,2", "DRILL,FEDTO,9,RAPTO,3", "DRILL,9,60,2"]


@pytest.mark.slow
def test_any_cycle_gives_a_program_or_diagnostics():
    random = np.random.default_rng(7)
    kept = 0
    for _ in range(1500):
        lines = ["UNITS/MM", "FEDRAT/100", "RAPID", "GOTO/0,0,50"]
        for _ in range(random.integers(1, 3)):
            items = random.choice(SOUND_CYCLES).split(",")
            for _ in range(random.integers(0, 2)):
                items.insert(random.integers(0, len(items) + 1), random.choice(CYCLE_ITEMS))
            if random.random() < 0.2:
                items = random.choice(CYCLE_ITEMS, random.integers(0, 6)).tolist()
            lines += [f"CYCLE/{','.join(items)}", "GOTO/1,2,3", "GOTO/4,5,6,.1,0,.995"]
        names = ((), ("depth", "feed", "clearance"))[random.integers(2)]
        options = ReadOptions(dialect=random.choice([None, "nx", "creo", "solidworks", "catia"]), cycle_values=names)
        program, diagnostics = read("\n".join(lines), "part.cl", options)
        assert (program is None) == bool(errors(diagnostics)), lines
        if program is not None:
            kept += 1
            assert np.isfinite(program.position).all()
            assert (program.feed[program.kind == Kind.LINE] > 0).all()
    assert kept > 100


@pytest.mark.parametrize(
    ("dialect", "cycle"),
    [("creo", "DRILL,DEPTH,5,CLEAR,2,RETURN,0"), ("nx", "DRILL,FEDTO,-5,RAPTO,2,RTRCTO,AUTO")],
)
def test_a_program_that_begins_with_a_hole_keeps_clear_of_it_on_the_way_to_lower_ones(dialect, cycle):
    """The height before the first hole is its clearance: from the lower holes the tool rose to its surface only."""
    head = f"UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nCYCLE/{cycle}\n"
    found, _ = read(f"{head}GOTO/0,0,10\nGOTO/50,0,0\nGOTO/80,0,0\nCYCLE/OFF\nFINI\n", "a.cl", ReadOptions(dialect))
    rapid = found.position[found.kind == Kind.RAPID]
    sideways = np.abs(np.diff(rapid[:, 0])) > 0
    assert rapid[1:][sideways][:, 2].tolist() == rapid[:-1][sideways][:, 2].tolist() == [12, 12]


@pytest.mark.parametrize(
    ("dialect", "code"), [("apt", "L419"), ("catia", "L419"), ("makino", "L419"), ("solidworks", "L412")]
)
def test_a_dwell_in_turns_is_refused_where_the_cam_system_has_none(dialect, code):
    """It ended in a KeyError."""
    cycle = "SPINDL/500,CLW\nCYCLE/DRILL,FEDTO,5,RAPTO,2,DWELL,REV,3\nGOTO/1,0,0\nCYCLE/OFF\nFINI\n"
    found, diagnostics = read(f"UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\n{cycle}", "a.cl", ReadOptions(dialect))
    assert found is None
    assert [(fault.code, fault.place.line) for fault in errors(diagnostics)] == [(code, 5)]
