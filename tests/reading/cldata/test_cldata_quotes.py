# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is quoted is text: a $ in it continues nothing, and a $$ begins no comment.

The second opinion reads character by character: a quote opens a text where the same quote closes it on its line.
"""

import numpy as np
import pytest

from pkm_post.reading.cldata import read
from pkm_post.reading.cldata.logical_lines import JOINT, decoded, logical_lines

PIECES = [
    "GOTO/1,2,3",
    "SYN/",
    ",",
    "'a'",
    "'$'",
    "'$$ b'",
    '"$ \'"',
    '"$$"',
    "'",
    '"',
    "$$ c",
    "$$ it's 'so'",
    " ",
    "N1",
]
STRAY = "a $ within a line"
ENDS = ["\n", "\n", "\n", "$\n", "$ \n", "$ $$ d 'e'\n"]


def statements(text):
    """The logical lines of a text, each with the number of its first line."""
    done, current, number, first = [], "", 1, 1
    for line in text.split("\n"):
        kept, goes_on = without_comment(line)
        current += kept
        if goes_on:
            current += JOINT
        else:
            done.append((current, first))
            current, first = "", number + 1
        number += 1
    return done


def without_comment(line):
    """A line up to its comment, and whether it goes on in the next one."""
    place = 0
    while place < len(line):
        if line[place] in "'\"" and line.find(line[place], place + 1) > 0:
            place = line.index(line[place], place + 1)
        elif line.startswith("$$", place):
            return line[:place], False
        elif line[place] == "$":
            behind = line[place + 1 :].strip()
            return (line[:place], True) if not behind or behind.startswith("$$") else (STRAY, False)
        place += 1
    return line, False


def test_quotes_and_comments_agree_with_reading_by_character():
    random = np.random.default_rng(12)
    quoted = compared = 0
    for _ in range(2000):
        lines = ["".join(random.choice(PIECES, random.integers(0, 6))) + random.choice(ENDS) for _ in range(6)]
        text = "".join(lines) + "FINI"
        expected = statements(text)
        if any(STRAY in line for line, _ in expected):
            continue  # refused with L106, wherever the line ends
        found = logical_lines(decoded(text))
        assert list(zip(found.text, found.number.tolist(), strict=True)) == expected, repr(text)
        compared += 1
        quoted += any("$" in line for line in found.text)
    assert compared > 1000
    assert quoted > 500


@pytest.mark.parametrize("text", ["'TLAXIS','$$*TLAXIS'", '"a$","$$"', "'it is $ 5'"])
def test_a_statement_with_quoted_dollars_is_read(text):
    program, told = read(f"UNITS/MM\nFEDRAT/100,MMPM\nSYNONYM/{text} $$ not read\nGOTO/1,2,3\nGOTO/1,2,4\n", "part.apt")
    assert [fault.code for fault in told] == ["L411", "L404"]
    assert program.position.tolist() == [[1, 2, 3], [1, 2, 4]]
