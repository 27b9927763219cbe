# SPDX-License-Identifier: LGPL-2.1-or-later
"""Percent signs: where a file ends."""

import pytest

from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.reading.gcode.scan import scan, scan_by_block

PROGRAM = "G0 X0 Y0 Z5\nG1 Z-1 F100\n"
WAYS = pytest.mark.parametrize("way", [scan, scan_by_block])


@WAYS
@pytest.mark.parametrize(
    ("text", "closed"),
    [
        (PROGRAM, False),
        (f"%\n{PROGRAM}", False),
        (f"%\n{PROGRAM}%", True),
        (f"%\n{PROGRAM}%\n", True),
        (f"{PROGRAM}%\n", True),
        (f"\n(of 50 % aluminium)\n  % (leader)\n{PROGRAM}\t%; done\n", True),
        (f"%\n%\n(two leaders)\n{PROGRAM}", False),
        (f"%\n{PROGRAM}(100 %)\n; 100%\n", False),
    ],
)
def test_a_percent_sign_behind_a_block_closes_a_file(way, text, closed):
    for content in (text, text.replace("\n", "\r\n"), text.encode()):
        blocks, told = way(content, "part.ngc")
        assert (blocks.closed, told) == (closed, ())


@WAYS
@pytest.mark.parametrize("behind", ["G0 X500\n", "(lost)\n\nwhatever [ is here\n", "%\nG0 X500\n%\n"])
def test_what_is_behind_the_end_is_not_read_and_told(way, behind):
    blocks, (told,) = way(f"%\n{PROGRAM}%\n{behind}", "part.ngc")
    lines = f"%\n{PROGRAM}%\n{behind}".splitlines()
    first = next(number for number, line in enumerate(lines, 1) if number > 4 and line[:1] not in ("", "(", "%"))
    assert (told.code, told.place.line, told.found) == ("G212", first, lines[first - 1])
    assert blocks.line.tolist() == [2, 3]


@WAYS
def test_nothing_is_told_of_an_empty_trailer(way):
    assert way(f"{PROGRAM}M2\n%\n\n(end of tape)\n%\n", "part.ngc")[1] == ()


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("M2\n", True),
        ("M30\n", True),
        ("%\n", True),
        ("", False),
        ("M0\n", False),
        ("(M2)\n", False),
        ("o1 if [1]\nM2\no1 endif\n", True),
        ("o1 if [0]\nM2\no1 endif\n", False),
        ("#1=2\nM#1\n", True),
        ("M98 P7\nO7\nG0 Z5\nM99\n", False),
        ("M98 P7\nM30\nO7\nG0 Z5\nM99\n", True),
        ("#1=1\nG0 Z[#1]\n%\n", True),
    ],
)
def test_a_whole_program_has_an_end_that_is_come_to(text, ends):
    program, told = read(PROGRAM + text, "part.ngc", ReadOptions(needs_end=True))
    codes = [each.code for each in told]
    if "M99" in text and not ends:  # the subprogram behind the program is run into
        assert codes == ["G312"]
    else:
        assert codes == ([] if ends else ["G430"])
    assert (program is not None) == ends


def test_a_line_by_hand_needs_no_end():
    assert read(PROGRAM, "MDI")[1] == ()
