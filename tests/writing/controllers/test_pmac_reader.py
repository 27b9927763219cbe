# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from dataclasses import replace

import numpy as np
import pytest
from controller_settings import settings_for
from hypothesis import given, strategies
from hypothesis import settings as hypothesis_settings
from strut_motions import with_rests

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.pmac import program_text, read_program
from pkm_post.writing.controllers.pvt import reader

SETTINGS = settings_for(approach_speed=12.5)
FILE = "job.pmc"
HALF_LENGTH_DIGIT = 0.5e-6 * 1.001
HALF_SPEED_DIGIT = 0.5e-4 * 1.001
EVENTS = {
    EventKind.TOOL_CHANGE: strategies.integers(0, 999),
    EventKind.SPINDLE: strategies.integers(-99_999_999, 99_999_999).map(lambda thousandths: thousandths / 1000),
    EventKind.COOLANT: strategies.sampled_from([0, 1, 2]),
    EventKind.DWELL: strategies.integers(0, 8_388_607_000).map(lambda microseconds: microseconds / 1e6),
    EventKind.STOP: strategies.sampled_from([0, 1]),
}


@strategies.composite
def motions(draw):
    intervals = draw(strategies.lists(strategies.sampled_from([1, 5, 20, 20, 20, 4095]), max_size=12))
    knots = len(intervals) + 1
    rng = np.random.default_rng(draw(strategies.integers(0, 2**32 - 1)))
    rows = sorted(draw(strategies.lists(strategies.integers(0, knots - 1), max_size=5)))
    kinds = [draw(strategies.sampled_from(list(EVENTS))) for _ in rows]
    events = tuple(Event(row, kind, float(draw(EVENTS[kind]))) for row, kind in zip(rows, kinds, strict=True))
    speed = rng.normal(0, 30, (knots, 6))
    speed[[0, -1, *rows]] = 0.0
    return StrutMotion(np.cumsum([0, *intervals]), rng.uniform(300, 1500, (knots, 6)), speed, events)


def _same(first, second):
    columns = ("time_ms", "length", "speed")
    same_columns = all(np.array_equal(getattr(first, name), getattr(second, name)) for name in columns)
    return same_columns and first.events == second.events


@pytest.mark.slow
@hypothesis_settings(derandomize=True, deadline=None)
@given(motions())
def test_what_was_written_reads_back_to_the_printed_decimals(motion):
    text = program_text(motion, SETTINGS, ["any heading"])
    read, faults = read_program(text, SETTINGS, FILE)
    assert faults == ()
    assert np.array_equal(read.time_ms, motion.time_ms)
    np.testing.assert_allclose(read.length, motion.length, rtol=0, atol=HALF_LENGTH_DIGIT)
    np.testing.assert_allclose(read.speed, motion.speed, rtol=0, atol=HALF_SPEED_DIGIT)
    assert read.events == motion.events
    assert program_text(read, SETTINGS, ["any heading"]) == text


def test_a_program_in_other_settings_reads_back(job):
    codes = SETTINGS.codes | {"stop": 'CMD"H" M0', "spindle_counterclockwise": "S{value:.1f} M4"}
    other = replace(SETTINGS, letters=tuple("ZYXWVU"), program=3, codes=codes)
    text = program_text(job, other, [])
    read, faults = read_program(text, other, FILE)
    assert faults == ()
    assert read.events == job.events
    assert read_program(text, SETTINGS, FILE)[0] is None


def _program(job):
    return program_text(job, SETTINGS, ["heading"])


MOVE = "A512.062500:3.1250"
FAULTS = {
    "unknown line": ("ABS\n", "ABS\nFOO12\n", 7, 1),
    "blank line": ("ABS\n", "ABS\n\n", 7, 1),
    "trailing space": ("ABS\n", "ABS \n", 6, 4),
    "wrong letter": (MOVE, "D512.062500:3.1250", 16, 1),
    "missing strut": (" B513.062500:3.1250", "", 16, 20),
    "missing last strut": (" W517.062500:3.1250", "", 16, 95),
    "duplicated letter": ("B513.062500:3.1250", "A513.062500:3.1250", 16, 20),
    "seventh axis": ("W517.062500:3.1250\n", "W517.062500:3.1250 X1.0:0.0\n", 16, 114),
    "missing speed": ("B513.062500:3.1250", "B513.062500", 16, 31),
    "exponent in a length": (MOVE, "A5.120625E+2:3.1250", 16, 10),
    "exponent in a speed": (MOVE, "A512.062500:3.1E0", 16, 16),
    "no digit before the point": (MOVE, "A.062500:3.1250", 16, 2),
    "no digit after the point": (MOVE, "A512.:3.1250", 16, 5),
    "not a number": (MOVE, "Anan:3.1250", 16, 2),
    "comma": (MOVE, "A512,0625:3.1250", 16, 5),
    "leading zeros": (MOVE, "A0512.062500:3.1250", 16, 3),
    "comment behind a move": (MOVE, MOVE + " ; fast", 16, 20),
    "fraction of a millisecond": ("PVT20\n", "PVT20.5\n", 15, 6),
    "interval of zero": ("PVT20\n", "PVT0\n", 15, 4),
    "interval beyond the controller": ("PVT20\n", "PVT4096\n", 15, 4),
    "interval of absurd size": ("PVT20\n", "PVT2" + "0" * 50 + "\n", 15, 19),
    "no interval": ("PVT20\n", "", 15, 1),
    "PVT before OPEN": ("OPEN PROG 10\n", "PVT20\nOPEN PROG 10\n", 4, 1),
    "missing CLEAR": ("CLEAR\n", "", 5, 1),
    "missing OPEN": ("OPEN PROG 10\n", "", 4, 1),
    "other program number": ("OPEN PROG 10\n", "OPEN PROG 100\n", 4, 13),
    "missing FRAX": ("FRAX(A,B,C,U,V,W)\n", "", 7, 1),
    "FRAX of other axes": ("FRAX(A,B,C,U,V,W)", "FRAX(A,B,C,U,V)", 7, 6),
    "faster approach": ("F12.5\n", "F125\n", 9, 1),
    "no approach": ("A512.000000 B513.000000 C514.000000 U515.000000 V516.000000 W517.000000\n", "", 10, 1),
    "no rest after the approach": ("DWELL0\nT3", "T3", 11, 1),
    "code while moving": ("PVT20\n", "PVT20\nM8\n", 16, 1),
    "unknown code": ("M8\n", "M88\n", 14, 3),
    "code of a negative value": ("T3 M6", "T-3 M6", 12, 2),
    "negative dwell": ("DWELL500", "DWELL-500", 20, 6),
    "dwell beyond the controller": ("DWELL500", "DWELL8388608", 20, 6),
    "speed at an interruption": ("A512.125000:0.0000", "A512.125000:0.0001", 18, 1),
    "missing LINEAR": ("LINEAR\nCLOSE\n", "CLOSE\n", 30, 1),
    "missing CLOSE": ("LINEAR\nCLOSE\n", "LINEAR\n", 31, 1),
    "text after CLOSE": ("LINEAR\nCLOSE\n", "LINEAR\nCLOSE\nR\n", 32, 1),
    "comment after CLOSE": ("LINEAR\nCLOSE\n", "LINEAR\nCLOSE\n; end\n", 32, 1),
    "comment beyond ASCII": ("; heading", "; h\xe4ding", 1, 4),
    "comment between the codes": ("M8\n", "M8\n; here\n", 15, 1),
    "comment within the moves": ("PVT20\n", "PVT20\n; here\n", 16, 1),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_malformed_program_is_reported_to_the_column(job, name):
    old, new, line, column = FAULTS[name]
    text = _program(job)
    assert old in text
    read, faults = read_program(text.replace(old, new, 1), SETTINGS, FILE)
    assert read is None
    assert {fault.code for fault in faults} == {"C101"}
    assert (faults[0].place.file, faults[0].place.line, faults[0].place.column) == (FILE, line, column)


@pytest.mark.parametrize("name", ["missing CLEAR", "wrong letter", "no interval", "PVT before OPEN", "unknown code"])
def test_one_mistake_is_reported_once(job, name):
    old, new, _, _ = FAULTS[name]
    assert len(read_program(_program(job).replace(old, new, 1), SETTINGS, FILE)[1]) == 1


def test_every_mistake_is_reported(job):
    text = _program(job).replace("PVT20", "PVT20.5").replace("M7", "M77").replace("W516.500000:", "W516.5OOOOO:")
    faults = read_program(text, SETTINGS, FILE)[1]
    assert [(fault.place.line, fault.place.column) for fault in faults] == [(15, 6), (19, 3), (26, 102)]
    assert faults[0].found == "'.5', expected the end of the line"
    assert faults[1].found == "'7', expected the end of the line"
    assert faults[2].found == "'OOOOO:0.0000', expected ':'"


def test_a_line_that_is_too_long_is_reported(job):
    longest = max(map(len, _program(job).splitlines()))
    assert read_program(_program(job), replace(SETTINGS, line_limit=longest), FILE)[1] == ()
    read, faults = read_program(_program(job), replace(SETTINGS, line_limit=longest - 1), FILE)
    assert read is None
    assert [(fault.code, fault.place.line, fault.place.column) for fault in faults] == [
        ("C103", line, longest) for line in (16, 17, 26)
    ]


def test_the_list_of_faults_is_limited():
    read, faults = read_program("nonsense\n" * 1000, SETTINGS, FILE)
    assert read is None
    assert [fault.place.line for fault in faults] == list(range(1, 21))


@pytest.mark.parametrize("text", ["", "\n", "\x00", "CLOSE"])
def test_what_is_no_program_at_all_is_a_fault(text):
    read, faults = read_program(text, SETTINGS, FILE)
    assert read is None
    assert faults


def test_a_speed_at_the_very_end_is_read_as_it_is(job):
    text = _program(replace(job, events=()))
    read, faults = read_program(text.replace("A511.500000:0.0000", "A511.500000:-7.5"), SETTINGS, FILE)
    assert faults == ()
    assert read.speed[-1].tolist() == [-7.5, 0, 0, 0, 0, 0]


@pytest.mark.slow
def test_a_program_cut_off_anywhere_is_a_fault(job):
    text = _program(job)
    for end in range(len(text) - 1):
        faults = read_program(text[:end], SETTINGS, FILE)[1]
        assert faults
        assert faults[-1].place.line <= text[:end].count("\n") + 1


def _mutations(text, characters, replacements, count):
    rng = np.random.default_rng(20031)
    body = text.index("CLOSE\n")
    places = [match.start() for match in re.finditer(characters, text) if match.start() >= body]
    for place in rng.choice(places, count):
        others = [character for character in replacements if character != text[place]]
        yield text[:place] + others[rng.integers(len(others))] + text[place + 1 :]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("characters", "replacements"),
    [(r"[0-9]", "0123456789"), (r".", "".join(map(chr, range(32, 127))) + "\n")],
    ids=["digits", "characters"],
)
def test_no_changed_character_goes_unnoticed(job, characters, replacements):
    text = _program(job)
    original = read_program(text, SETTINGS, FILE)[0]
    for mutation in _mutations(text, characters, replacements, 500):
        read, faults = read_program(mutation, SETTINGS, FILE)
        assert faults or not _same(read, original), mutation


def test_long_runs_and_times_that_change_at_every_knot_read_back():
    knots = 20_001  # several chunks of the writer and of the reader
    rng = np.random.default_rng(7)
    speed = rng.normal(0, 30, (knots, 6))
    speed[[0, -1]] = 0.0
    for intervals in (np.full(knots - 1, 20), np.arange(knots - 1) % 2 + 19):
        time_ms = np.concatenate([[0], np.cumsum(intervals)])
        motion = StrutMotion(time_ms, rng.uniform(300, 1500, (knots, 6)), speed, ())
        read, faults = read_program(program_text(motion, SETTINGS, []), SETTINGS, FILE)
        assert faults == ()
        assert np.array_equal(read.time_ms, time_ms)
        np.testing.assert_allclose(read.length, motion.length, rtol=0, atol=HALF_LENGTH_DIGIT)


@pytest.mark.slow
@pytest.mark.parametrize("size", [1, 90, 1000])
def test_it_does_not_matter_where_a_text_is_cut_to_be_read(job, monkeypatch, size):
    changed = [_program(job).replace(old, new, 1) for old, new, _, _ in FAULTS.values()]
    texts = [_program(job), _program(with_rests(7, 100)), *changed, "", "\n", "CLOSE", "nonsense\n" * 1000]
    narrow = replace(SETTINGS, line_limit=113)
    whole = [read_program(text, settings, FILE) for text in texts for settings in (SETTINGS, narrow)]
    monkeypatch.setattr(reader, "_CHUNK", size)
    cut = [read_program(text, settings, FILE) for text in texts for settings in (SETTINGS, narrow)]
    for (motion, faults), (other, others) in zip(whole, cut, strict=True):
        assert faults == others
        assert (motion is None) == (other is None)
        assert motion is None or _same(motion, other)


def test_moves_that_are_printed_in_another_way_are_read_as_well():
    text = _program(with_rests(7, 100))
    motion, _ = read_program(text, SETTINGS, FILE)
    rng = np.random.default_rng(4)
    lines = text.split("\n")
    moves = [row for row, line in enumerate(lines) if ":" in line]
    for row in rng.choice(moves, 40, replace=False):
        lines[row] = re.sub(r"\.0+(?=[: ]|$)", "", lines[row])
        lines[row] = re.sub(r"(\.[0-9]*[1-9])0+(?=[: ]|$)", r"\1", lines[row])
        lines[row] = re.sub(r"(\.[0-9]*):", r"\g<1>00000000000:", lines[row], count=2)
    read, faults = read_program("\n".join(lines), replace(SETTINGS, line_limit=1000), FILE)
    assert faults == ()
    assert _same(read, motion)
