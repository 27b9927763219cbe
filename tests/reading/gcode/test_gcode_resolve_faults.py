# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs that are well written and mean nothing: their first lines say what is wrong with them, and where."""

import re
from pathlib import Path

import pytest

from pkm_post.model import RULES, Severity, Tool
from pkm_post.reading.gcode.codes import Word
from pkm_post.reading.gcode.diagnostics import column_of
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan

PROGRAMS = sorted((Path(__file__).parents[2] / "data" / "bad_gcode_meaning").glob("*.ngc"))
EXPECTS = re.compile(r"; expects (G4\d\d|G317) (\d+):(\d+)\n")
READS_WITH = re.compile("(?:; expects .*\n)+; reads with (\\S+)\n")
TOOLS = {1: Tool(1, "end mill", 10.0, 0.0, 60.0), 2: Tool(2, "drill", 5.0, 0.0, 90.0)}


def options(words):
    if words == "G54=":
        return ReadOptions(tools=TOOLS, work_offsets={"G54": (0.0, 0.0, 0.0, 0.0)})
    name, _, value = (words or "axis_words=none").partition("=")
    return ReadOptions(tools=TOOLS, **{name: (int(value),) if name == "functions" else value})


def test_there_are_programs_for_every_code():
    assert len(PROGRAMS) > 70
    codes = {EXPECTS.match(path.read_text(encoding="utf-8")).group(1) for path in PROGRAMS}
    assert codes == {code for code in RULES if code.startswith("G4")} | {"G317"}


@pytest.mark.slow
@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_reports_what_its_first_lines_say(path):
    text = path.read_text(encoding="utf-8")
    expected = [(code, int(line), int(column)) for code, line, column in EXPECTS.findall(text)]
    words = READS_WITH.match(text)
    blocks, faults = scan(text, path.name)
    assert not faults
    program, faults = resolve(blocks, options(words and words[1]), text)
    diagnostics = [(fault.code, fault.place.line, fault.place.column) for fault in faults]
    assert sorted(diagnostics) == sorted(expected)
    assert (program is None) == any(RULES[code].severity is Severity.ERROR for code, *_ in expected)


def test_every_fault_of_a_program_is_reported():
    blocks, _ = scan("G0 X0 Y0 Z5 Q1\nG77\nG1 X1 A1\nG4\n", "part.ngc")
    _, faults = resolve(blocks, ReadOptions())
    assert [(fault.code, fault.place.line) for fault in faults] == [("G404", 1), ("G401", 2), ("G414", 3), ("G405", 4)]


def test_many_faults_of_a_kind_are_counted():
    blocks, _ = scan("G0 X0 Y0 Z5\n" + "G1 X1\n" * 1000, "part.ngc")
    _, faults = resolve(blocks, ReadOptions())
    assert len(faults) == 50
    assert str(faults[-1]).startswith("part.ngc: line 51: error G408") and "and 950 more like it" in str(faults[-1])


@pytest.mark.parametrize(
    ("words", "line", "column"),
    [
        ([Word("G", 12)], "N10 X1 G12", 8),
        ([Word("G", 12)], "g 012.0", 1),
        ([], "  N3 G1 X1", 3),
        ([Word("G", 3)], "G30 G3", 5),
        ([Word("X", -1.5)], "Y2 X-01.50", 4),
        ([Word("X", 1e12)], "Y0 X1000000000000", 4),
        ([Word("X", 1.23456789)], "Y0 X1.23456789", 4),
        ([Word("A3", 0.5)], "A3=1 a 3 = .5", 6),
        ([Word("NX", 0)], "N0 X0 nx0", 7),
        ([Word("TX")], "X0 TX0.5", 4),
        ([Word("G", 92), Word("G", 10)], "X5 G10 L2 P1", 4),
    ],
)
def test_the_column_is_that_of_the_first_word_in_the_line(words, line, column):
    assert column_of(words, line) == column


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoded", [str, str.encode])
def test_columns_with_any_line_ends_and_after_comments(end, encoded):
    text = encoded(f"G0 X0 Y0 Z0{end}(G77) G77 ; G77{end}")
    blocks, _ = scan(text, "part.ngc")
    (fault,) = resolve(blocks, ReadOptions(), text)[1]
    assert (fault.code, fault.place.line, fault.place.column) == ("G401", 2, 7)


def test_without_the_text_diagnostics_have_lines_only():
    (fault,) = resolve(scan("G0 X0 Y0 Z0\nG77\n", "part.ngc")[0], ReadOptions())[1]
    assert (fault.place.line, fault.place.column) == (2, 0)
