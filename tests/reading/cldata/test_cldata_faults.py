# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of CL data: bad programs state in their first line exactly what they must give."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pkm_post.model import Kind, Severity
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import DIALECTS, ReadOptions, interpreter, read
from pkm_post.reading.cldata.diagnostics import EXPECTED, MAX_REPORTED
from pkm_post.reading.grammar import STATEMENT, parser_of

BAD_PROGRAMS = sorted((Path(__file__).parents[2] / "data" / "bad_cldata").glob("*.cl"))
HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nCUTTER/10\nFEDRAT/600,MMPM\nGOTO/0,0,0\n"
EXPECTATION = re.compile(rb"\$\$ expects (.+)")


def test_there_are_bad_programs():
    assert len(BAD_PROGRAMS) >= 40


@pytest.mark.parametrize("path", BAD_PROGRAMS, ids=lambda path: path.stem)
def test_bad_programs_give_the_stated_diagnostics(path):
    text = path.read_bytes()
    stated = EXPECTATION.match(text)
    assert stated, "the first line states what is expected, such as: $$ expects L202 2:4, L411 0:0"
    program, diagnostics = read(text, path.name)
    given = [f"{fault.code} {fault.place.line}:{fault.place.column}" for fault in diagnostics]
    assert ", ".join(given) == stated[1].decode()
    assert (program is None) == bool(errors(diagnostics))
    assert {fault.place.file for fault in diagnostics} == {path.name}


@pytest.mark.parametrize(
    "line, found",
    [
        ("GOTO/1,2.5mm,0", "'2.5mm'"),
        ("GOTO/1,\0,0", "character 0x00"),
        ("GOTO 1,2,3", "'1', expected '/', ',', '=' or the end of the statement"),
        ("TLON,GOFWD/(CIRCLE/1,2", "the end of the statement, expected ')'"),
        ("GOTO/1,2,3)", "')'"),
    ],
)
def test_diagnostics_state_what_was_found_and_expected(line, found):
    (fault,) = read(line, "part.cl")[1]
    assert fault.found == found


def test_every_terminal_has_words():
    terminals = {terminal.name for terminal in parser_of(STATEMENT).terminals}
    assert terminals - {"BLANK", "TEXT"} <= {name for names in EXPECTED.values() for name in names}


def test_a_hundred_errors_are_reported_and_the_others_counted():
    words = [f"W{chr(65 + index // 26)}{chr(65 + index % 26)}" for index in range(250)]
    diagnostics = read("".join(f"COPY/{word}\n" for word in words), "part.cl")[1]
    assert len(diagnostics) == MAX_REPORTED + 1
    assert (diagnostics[-1].code, diagnostics[-1].found) == ("L199", "and 150 more")


ALIKE, SIMILAR = (
    " (3950 times, in lines 2, 3, 4, 5, 6 and others)",
    ", and 3949 more like it, in lines 3, 4, 5, 6 and others",
)


@pytest.mark.parametrize(
    ("statement", "end"), [("GOTO/{0},;", ALIKE), ("GOTO/{0},1", SIMILAR), ("CYCLE/DRILL,DEPTH,1{0}", ALIKE)]
)
def test_equal_faults_are_one_with_their_number_and_first_lines(statement, end):
    text = "UNITS/MM\n" + "".join(f"{statement.format(number)}\n" for number in range(3950)) + "GOTO/1,2,3\nFINI\n"
    fault, *others = [each for each in read(text, "part.cl")[1] if each.severity is Severity.ERROR]
    assert (fault.place.line, others) == (2, [])
    assert fault.found.endswith(end)


def test_tools_of_unknown_length_are_counted_in_the_order_of_the_file():
    """One message said "tool 1 (4 times, in lines 9, 7, 5, 3)" of tools 4, 3, 2 and 1."""
    tools = "".join(f"LOAD/TOOL,{number}\nGOTO/{number},0,0\n" for number in (4, 3, 2, 1))
    fault = read(f"UNITS/MM\nCUTTER/10\n{tools}FINI\n", "part.cl")[1][0]
    assert (fault.code, fault.place.line) == ("L411", 3)
    assert fault.found == "tool 4, and 3 more like it, in lines 5, 7, 9"


def test_three_equal_faults_stand_each_by_itself():
    text = "UNITS/MM\nGOTO/1,1\nGOTO/2,;\nGOTO/2,1\nGOTO/3,1\nGOTO/4,;\n"
    assert [fault.place.line for fault in read(text, "part.cl")[1]] == [2, 3, 4, 5, 6]


def test_faults_of_all_steps_are_reported_together_without_their_consequences():
    """A bracket, an axis without direction that stays in force, an arc to a faulty point, and one that misfits."""
    text = (
        "UNITS/MM\nFEDRAT/300\nGOTO/0,0,0\nGOTO/(1,2,3\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0,0,0\n"
        "GOTO/0,20,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\nGOTO/1,2,3,0,0,0\nGOTO/1,2,4\nFINI\n"
    )
    found = [(fault.code, fault.place.line) for fault in read(text, "part.cl")[1] if fault.severity is Severity.ERROR]
    assert found == [("L203", 4), ("L402", 7), ("L408", 9), ("L405", 11)]


def test_a_missing_lark_is_named(monkeypatch):
    parser_of.cache_clear()
    monkeypatch.setitem(sys.modules, "lark", None)
    with pytest.raises(ImportError, match="needs lark: .* install "):
        read("GOTO/1,2,3", "part.cl")
    monkeypatch.undo()


@pytest.mark.slow
def test_any_bytes_give_a_program_or_diagnostics():
    random = np.random.default_rng(20)
    seed = b"UNITS/MM\nRAPID\nGOTO/1,2,3,0,0,1\nFEDRAT/5,MMPM\nCIRCLE/1,2,3,0,0,1\n$$-> CSYS/1 $\nCYCLE/DRILL,(TLON=')"
    for _ in range(300):
        text = bytearray(seed * 2)
        for place in random.integers(0, len(text), random.integers(1, 30)):
            text[place] = random.integers(0, 256)
        cut = random.integers(0, len(text))
        program, diagnostics = read(bytes(text[cut:] + text[:cut]), "fuzz.cl")
        assert (program is None) == bool(errors(diagnostics))
        noise = random.integers(0, 256, 200, dtype=np.uint8).tobytes()
        program, diagnostics = read(noise, "fuzz.cl")
        assert (program is None) == bool(errors(diagnostics))


def shown(values):
    return ",".join(f"{value:g}" for value in values)


NUMBERS = st.one_of(st.sampled_from([0.0, 1.0, -1.0, 10.0, 360.0, 1e9]), st.floats(-50, 50).map(lambda x: round(x, 3)))
WORDS = st.sampled_from(
    ["ON", "TANTO", "INTOF", "CANON", "PERPTO", "CLW", "CCLW", "ANGLE", "TIMES", "OFF", "MM", "DRILL", "FEDTO", "RAPTO"]
)
MAJORS = st.sampled_from([*sorted({*interpreter.HANDLERS, *interpreter.UNSUPPORTED} - {""}), *["GOTO"] * 40])
SURFACES = st.sampled_from(["PLANE", "LINE", "CIRCLE", "CYLNDR", "POINT", "VECTOR"])
PARTS = st.builds("({}/{})".format, SURFACES, st.lists(NUMBERS, max_size=7).map(shown))
ITEMS = st.lists(st.one_of(NUMBERS.map("{:g}".format), WORDS, PARTS, st.just("")), max_size=5).map(",".join)
COUNTS = st.sampled_from([3, 4, 6, 7, 9, 10, 11, 13, 14, 17])
COUNTED = COUNTS.flatmap(lambda count: st.lists(NUMBERS, min_size=count, max_size=count)).map(shown)
TLON = st.builds(
    "TLON,GOFWD/(CIRCLE/0,0,0,0,0,1,10),{},(PLANE/1,0,0,{:g})".format,
    st.sampled_from(["ON", "TANTO", "ON,2,INTOF", "PAST"]),
    NUMBERS,
)
SOUND = st.sampled_from([
    "RAPID", "AUTOPS", "FEDRAT/9", "GOTO/10,0,0", "GOTO/0,10,0", "GODLTA/0,0,1", "8,6,0", "UNITS/INCHES",
    "MSYS/1,2,3,0,1,0,-1,0,0", "MSYS/0,0,0,1,0,0,0,1,0", "$$ CIRCLE/0,0,0,0,0,1,10\nGOTO/8,6,0",
    "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/8,6,0\n0,10,0", "GOTO/10,0,0\nGOCLW/0,0,0,0,0,1,10,0,10,0",
    "GOTO/10,0,0\nINDIRP/10,5,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,2,INTOF,(PLANE/1,1,0,5)",
    "GOTO/10,0,0\nARCSLP/3\nARCDAT/0,0,0,0,0,1,10\nARCMOV/CCLW,10,0,3,720",
    "GOTO/10,0,0\nHELICAL/0,0,0,0,1,0,0,0,1,2,10,-10,0,9", "CYCLE/DRILL,FEDTO,5,RAPTO,2\nGOTO/3,3,0\nCYCLE/OFF",
])  # fmt: skip
RECORDS = st.one_of(st.builds("{}/{}".format, MAJORS, st.one_of(COUNTED, ITEMS)), COUNTED, TLON, SOUND)


@pytest.mark.slow
@settings(deadline=None, derandomize=True)
@given(st.one_of(st.lists(RECORDS, max_size=12), st.lists(SOUND, max_size=12)), st.sampled_from([None, *DIALECTS]))
def test_any_records_give_a_program_or_diagnostics(records, dialect):
    text = "\n".join(["UNITS/MM", "FEDRAT/100", "GOTO/10,0,0", *records])
    program, diagnostics = read(text, "part.cl", ReadOptions(dialect=dialect))
    assert (program is None) == bool(errors(diagnostics))
    if program is not None:
        assert np.isfinite(program.position).all()
        assert np.isfinite(program.arc_centre[program.kind == Kind.ARC]).all()


@pytest.mark.parametrize("piece", ["GOTO/1,", "1", "(", "A,", "$$", "'", "1.", "$ ", "A/(", " ", "-"])
def test_ten_megabytes_in_one_line(piece):
    program, diagnostics = read(piece * (10_000_000 // len(piece)), "long.cl")
    assert program is None
    assert errors(diagnostics)


@pytest.mark.parametrize("statement", [
    "MULTAX/ON,5", "MULTAX/ON,OFF", "AUTOPS/1", "STOP/3", "OPSTOP/OFF", "UNITS/MM,INCHES", "TRNTYP/WORLD,0,0,5",
    "TRANS/NOMORE,1,2,3", "TRANS/1,2,3,NOMORE", "TRACUT/NOMORE,OFF", "TRACUT/LAST,NOMORE,7", "ORIGIN/OFF,1",
    "CYCLE/OFF,DRILL,DEPTH,5", "CYCLE/OFF,ON", "CYCLE/ON,2", "FEDRAT/INVERS,5,OFF", "FEDRAT/AUTO", "FEDRAT/MMPM,OFF",
    "FEDRAT/100,LENGTH", "FEDRAT/100,(POINT/1,2,3)", "SPINDL/30,SMM,RADIUS,CLW", "SPINDL/30,SMM,MAXRPM",
    "SPINDL/MAXRPM,-3", "SPINDL/500,(POINT/1,2,3)", "COOLNT/ON,AIR", "COOLNT/FLOOD,XX", "DELAY/2,(POINT/1,2,3)",
    "CUTTER/8,,1", "CUTTER/8,1,3,1,0,0,30,7",
])  # fmt: skip
def test_items_that_no_form_of_a_statement_has_are_faults(statement):
    (fault,) = errors(read(f"{HEAD}{statement}\nGOTO/5,0,0\n", "part.cl")[1])
    assert (fault.code in ("L401", "L402"), fault.place.line) == (True, 6)


@pytest.mark.parametrize(
    "statement",
    ["MULTAX", "MULTAX/OFF", "STOP", "TRNTYP/WORLD,0,0,0", "TRANS/NOMORE", "COOLNT/ON,HIGH", "FEDRAT/9,LENGTH,80"],
)
def test_statements_of_these_forms_are_read(statement):
    program, diagnostics = read(f"{HEAD}{statement}\nGOTO/5,0,0\n", "part.cl")
    assert (len(program), errors(diagnostics)) == (2, ())


@pytest.mark.parametrize(
    "statement, reported",
    [
        ("DELAY/60", False),
        ("DELAY/61", True),
        ("DWELL/1500", True),
        ("DELAY/1200,REV", False),
        ("DELAY/1300,REV", True),
        ("CYCLE/DRILL,DEPTH,5,CLEAR,3,DWELL,500", True),
        ("CYCLE/DRILL,DEPTH,5,CLEAR,3,DWELL,5", False),
    ],
)
def test_dwells_of_more_than_a_minute_are_reported(statement, reported):
    _, diagnostics = read(f"{HEAD}SPINDL/1200,CLW\n{statement}\nGOTO/5,0,0\n", "part.cl")
    assert [fault.place.line for fault in diagnostics if fault.code == "L448"] == [7] * reported
