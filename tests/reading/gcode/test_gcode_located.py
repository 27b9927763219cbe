# SPDX-License-Identifier: LGPL-2.1-or-later
"""The word that a fault of meaning speaks of is found in its line."""

import pytest

from pkm_post.model import Diagnostic, Place
from pkm_post.reading.gcode.located import located


def column(found, text, line=1, given=0):
    (fault,) = located([Diagnostic("G401", Place("part.ngc", line=line, column=given), found)], text)
    return fault.place.column


@pytest.mark.parametrize(
    ("found", "text", "expected"),
    [
        ("G12", "N10 X1 G12", 8),
        ("G12", "g 012.0", 1),
        ("no F", "  N3 G1 X1", 3),
        ("G3", "(G3) G3", 6),
        ("G3", "G30 G3 ; G3", 5),
        ("X-1.5 and more", "Y2 X-01.50", 4),
        ("X1e+12", "Y0 X1000000000000", 4),
        ("G92 without X, Y or Z", "G10 L2 P1 (nothing else)", 1),
    ],
)
def test_column_of_the_first_word_that_is_there(found, text, expected):
    assert column(found, text) == expected


def test_lines_end_in_any_way():
    for end in ("\n", "\r\n", "\r"):
        assert column("G12", f"G0{end}X1 G12{end}", line=2) == 4
    assert column("G12", b"\xff\nX1 G12", line=2) == 4


def test_what_has_a_place_keeps_it():
    assert column("G12", "X1 G12", given=1) == 1
    assert column("nothing moves", "", line=0) == 0
    assert column("G12", "G12", line=7) == 0
