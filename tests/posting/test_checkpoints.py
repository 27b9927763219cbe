# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checkpoints in long programs: between two of them a step makes few columns, whatever the length of the program.

Work is counted, not timed: the bytes of all arrays that come into being in the thread that posts, found among the
variables of the functions of PKM Post line by line. Pieces are small here, so that what is left are whole columns.
"""

import os
import sys
import weakref

import numpy as np
import pytest
from long_programs import PIECES, scan
from machines import text_without_jerk

import pkm_post
from pkm_post.certificate import dynamics, playback
from pkm_post.machine.reach import path_bounds
from pkm_post.model import columns
from pkm_post.options.choices import Options
from pkm_post.planning import rough_limits, tool_path
from pkm_post.planning.knots import deviation
from pkm_post.posting import post_file, run
from pkm_post.reading.gcode import scan as scanner
from pkm_post.reading.part_program import ReadingOptions
from pkm_post.report import page, summary
from pkm_post.toolpath.compressor import bounds, compress
from pkm_post.writing import manifest
from pkm_post.writing.controllers import program_files

LINES = 1000, 2000
PIECE = 64
"""Rows of a piece."""
COLUMNS = 50.0
"""Columns of 8 bytes a line that may be made between two checkpoints: a fifth of a second of a million lines."""
OTHERS = (
    (compress, "_ROWS_AT_ONCE"),
    (bounds, "_PIECES_AT_ONCE"),
    (path_bounds, "_AT_ONCE"),
    (tool_path, "_JOINTS_AT_ONCE"),
    (deviation, "_POINTS_AT_ONCE"),
    (playback, "_TO_FIND_THE_WORST"),
    (sys.modules["pkm_post.toolpath.continuity"], "_AT_ONCE"),
    (rough_limits, "_AT_ONCE"),
    (dynamics, "_MOST_KNOTS"),
    (page, "_CHART_POINTS"),
    (summary, "_AT_ONCE"),
)
"""Sizes of pieces that workers compute, and of samples of the whole motion."""
PACKAGE = os.path.dirname(pkm_post.__file__)
"""As the names of files in code have it, "/./" and all."""
OF_ALL = (__file__, columns.__file__, sys.modules["pkm_post.model.checkpoint"].__file__)
"""Files in which all checkpoints are, and not the place of any."""
ON_PALLET = np.eye(4)
ON_PALLET[2, 3] = 200.0
COUNTED = np.ndarray, bytes, str


class Work:
    """Counts the bytes of new arrays and texts between checkpoints, by the places of these.

    Known are the arrays that own their numbers, and texts; seen is what needs no second look, views as well.
    """

    def __init__(self):
        self.known, self.seen, self.bytes, self.since = {}, {}, 0, ""
        self.most = {}

    def visit(self):
        frame = sys._getframe(1)
        while frame.f_code.co_filename in OF_ALL:
            frame = frame.f_back
        here = f"{frame.f_code.co_filename.removeprefix(PACKAGE)}:{frame.f_lineno}"
        between = self.since, here
        self.most[between] = max(self.bytes, self.most.get(between, 0))
        self.bytes, self.since = 0, here

    def trace(self, frame, event, _):
        return self.line if frame.f_code.co_filename.startswith(PACKAGE) else None

    def line(self, frame, event, _):
        seen = self.seen.get
        for value in frame.f_locals.values():
            for each in value if type(value) is tuple else (value,):
                if type(each) in COUNTED:
                    met = seen(id(each))
                    if met is None or met() is not each:
                        self.meet(each)
        return self.line

    def meet(self, value):
        if type(value) is not np.ndarray:
            self.seen[id(value)] = lambda: value
            self.add(value, lambda: value, len(value))
        elif value.dtype.names is None:  # records are those of a file
            self.seen[id(value)] = weakref.ref(value)
            self.add_array(value)

    def add_array(self, array):
        owner = array
        while type(owner.base) is np.ndarray:
            owner = owner.base
        self.add(owner, weakref.ref(owner), array.nbytes if all(array.strides) else 0)

    def add(self, value, reference, size):
        known = self.known.get(id(value))
        if known is None or known() is not value:
            self.known[id(value)] = reference
            self.bytes += size


@pytest.fixture
def count(monkeypatch, tmp_path):
    """A function that posts so many lines, in one thread and small pieces; the most bytes between two checkpoints."""
    for module, name in (*PIECES, *OTHERS):
        monkeypatch.setattr(module, name, PIECE)
    for module, name in ((scanner, "PIECE"), (manifest, "_AT_ONCE"), (program_files, "_AT_ONCE")):
        monkeypatch.setattr(module, name, 16 * PIECE)
    for module, name, size in (
        (dynamics, "_INSTANTS_AT_ONCE", 257),
        (path_bounds, "_GROUPS_AT_ONCE", PIECE // 8),  # each stands for 8 mm of the path
        (playback, "_AT_ONCE", 257),
        (playback, "_INSTANTS", playback._INSTANTS[:5]),
    ):
        monkeypatch.setattr(module, name, size)  # all instants of an interval, at most
    monkeypatch.setenv("PKM_THREADS", "1")
    beat = run.beat

    def counted(lines, leans):
        work = Work()

        def counting(progress):
            visit = beat(progress)
            return lambda: (work.visit(), visit())

        for module in (run, sys.modules["pkm_post.posting.post_file"]):
            monkeypatch.setattr(module, "beat", counting)
        file, machine = tmp_path / "scan.ngc", tmp_path / "jumping.toml"
        file.write_text(scan(lines, leans))
        machine.write_text(text_without_jerk(), encoding="utf-8")
        reading = ReadingOptions(axis_words="vector" if leans else "none")
        options = Options(work_offset=ON_PALLET)
        before = sys.gettrace()
        sys.settrace(work.trace)
        try:
            post_file(file, machine, tmp_path / "out", options, {1: 120.0, 2: 100.0}, reading)
        finally:
            sys.settrace(before)
        return work.most

    return counted


@pytest.mark.slow
@pytest.mark.parametrize("leans", [False, True])
def test_few_columns_are_made_between_checkpoints(count, leans):
    """By the difference of two lengths: what does not depend on the length, as the pieces themselves, is in both."""
    few, many = (count(lines, leans) for lines in LINES)
    assert len(many) > 100 and max(many.values()) > 8 * PIECE  # it visits checkpoints, and counts between them
    made = {between: (most - few.get(between, 0)) / 8 / (LINES[1] - LINES[0]) for between, most in many.items()}
    assert {between: number for between, number in made.items() if number > COLUMNS} == {}
