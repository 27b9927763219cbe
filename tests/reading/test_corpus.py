# SPDX-License-Identifier: LGPL-2.1-or-later
"""The corpus: small programs of each language, flavour and dialect give the motion that ``corpus`` has for them.

``tests/reading/corpus`` has the programs: those of LinuxCNC with the moves that rs274 makes, the others with moves from
the manuals that their files name.

    python3 tests/reading/test_corpus.py    prints what is read as expected, and what is not
"""

import re
import sys
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).parent / "corpus")]

from corpus import HEADS, HERE, rows_of, sections  # noqa: E402 - the path comes first

from pkm_post.model import Tool, errors  # noqa: E402
from pkm_post.reading.part_program import ReadingOptions, read_content  # noqa: E402

SUFFIXES = {"rs274": ".ngc", "fanuc": ".nc", "siemens": ".mpf"}
"""Suffixes of the files; the others are CL data."""
ENDS = {"rs274": "M2\n", "fanuc": "M30\n", "siemens": "M30\n"}
TOOLS = {number: Tool(number, "", 2.0 * number, 0.0, 100.0) for number in range(1, 4)}
LENGTHS = {0: 0.0, 1: 10.0, 2: 25.5, 3: 40.0}
FILES = sorted(HERE.glob("*.txt"))
ALL = [each for file in FILES for each in sections(file)]


def _point(text):
    return tuple(map(float, text.split(",")))


CONVERTED = {
    "machine_zero": _point,
    "block_delete": lambda text: text == "True",
    "feed": float,
    "functions": lambda text: tuple(map(int, text.split(","))),
    "left_out": lambda text: tuple(text.split(",")),
    "cycle_values": lambda text: tuple(text.split(",")),
    "cycle_kinds": lambda text: dict(pair.split(":") for pair in text.split(",")),
    "goto_values": lambda text: tuple(text.split(",")),
    "work_offsets": lambda text: {
        name: (*_point(origin), 0.0) for name, origin in (pair.split("@") for pair in text.split("+"))
    },
}


def given(section):
    """What the reader makes of a section: rows, or the codes of its faults."""
    language = section.file
    options = {name: CONVERTED.get(name, str)(text) for name, text in section.options.items()}
    lengths = LENGTHS if language == "rs274" else {}
    reading = ReadingOptions(tools=TOOLS, lengths=lengths, flavour=language if language in ENDS else None)
    reading = ReadingOptions(**(vars(reading) | options))
    text = HEADS.get(language, "") + section.program + ENDS.get(language, "")
    program, diagnostics = read_content(text.encode(), "part" + SUFFIXES.get(language, ".cls"), reading)
    if program is None:
        return ["refused " + ", ".join(dict.fromkeys(fault.code for fault in errors(diagnostics)))]
    return rows_of(program)


@pytest.mark.slow
@pytest.mark.parametrize("section", ALL, ids=[f"{each.file}: {each.title.split(' | ')[0]}" for each in ALL])
def test_the_motion_is_the_one_of_the_corpus(section):
    assert given(section) == section.rows()


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_construct_that_a_file_names_is_shown(file):
    text = HEADS.get(file.stem, "") + "\n".join(section.program for section in sections(file))
    words = file.read_text(encoding="utf-8").split("\n== ")[0].split("Shows: ")[1].split()
    assert [word for word in words if not _has(text, word)] == []


def _has(text, word):
    """Whether a text has a word; a code of G or M only with all of its digits."""
    behind = r"(?![0-9]|[.][0-9])" if re.fullmatch(r"[GM][0-9.]+", word) else ""
    return re.search(re.escape(word) + behind, text) is not None


if __name__ == "__main__":
    for each in ALL:
        found = given(each)
        print("ok " if found == each.rows() else "NOT", f"{each.file}: {each.title}")
        if found != each.rows():
            print("   expected:", "; ".join(each.rows()), "\n   found:   ", "; ".join(found))
