# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of length: each word that gives it, alone, with each other one, and with the option."""

import itertools
import re

import numpy as np
import pytest

from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read

MM = {"mm": 1.0, "inch": 25.4}
"""mm in one unit."""
FEEDS = {
    "FEDRAT/MMPM,60": ("mm", 1.0), "FEDRAT/60,MMPM": ("mm", 1.0), "FEDRAT/IPM,6": ("inch", 2.54),
    "FEDRAT/6,IPM": ("inch", 2.54), "FEDRAT/0.1,MMPR": ("mm", 2.0), "FEDRAT/IPR,.01": ("inch", 5.08),
    "FEDRAT/1,FPM": ("inch", 5.08),
}  # fmt: skip
"""Feeds with their unit of length, and what they are in mm/s at 1200 turns a minute."""
COMMENTS = {
    "$$ UNITS: MM": "mm", "$$ Output units = Inches": "inch", "PPRINT UNITS MILLIMETERS": "mm", "$$ UNIT/IN": "inch",
    "REMARK PART UNITS : INCH": "inch", "$$ units: millimetres.": "mm",
}  # fmt: skip
UNITS = {"UNITS/MM": "mm", "UNITS/INCHES": "inch", "UNIT/INCH": "inch", "UNIT/MM": "mm"}
NX = "TOOL PATH/A,TOOL,B\nTLDATA/MILL,0.5,0.1,3,0,0\nMSYS/1,2,3,1,0,0,0,1,0\n"
WRITTEN = np.array([[1.0, 0.0], [5.0, 0.0], [3.0, 2.0]])
CIRCLE = "CIRCLE/3,0,0,0,0,1,2\nGOTO/3,2,0\n"


def text(*lines, feed="FEDRAT/PERMIN,60"):
    """A path with all that has a length: tool, frame, points, an arc and a feed."""
    return (
        NX
        + "\n".join([*lines, "LOAD/TOOL,1", "SPINDL/RPM,1200,CLW", "RAPID", "GOTO/1,0,0", feed])
        + (f"\nGOTO/5,0,0\n{CIRCLE}END-OF-PATH\n")
    )


def found(program, **options):
    made, diagnostics = read(program, "part.cls", ReadOptions(hand="right", **options))
    return made, [fault.code for fault in diagnostics if fault.code != "L411"], diagnostics


def assert_in(program, unit):
    """All lengths are as written, in this unit."""
    size = MM[unit]
    assert program.position[:, :2] == pytest.approx(size * WRITTEN, abs=1e-9)
    assert program.arc_centre[2] == pytest.approx([3 * size, 0, 0], abs=1e-9)
    assert program.tools[1].diameter == pytest.approx(0.5 * size)
    assert program.tools[1].corner_radius == pytest.approx(0.1 * size)


@pytest.mark.parametrize("feed", FEEDS)
def test_a_feed_says_the_unit_of_a_file_without_units(feed):
    unit, speed = FEEDS[feed]
    program, codes, _ = found(text(feed=feed))
    assert codes == ["L410"]
    assert_in(program, unit)
    assert program.feed[1] == pytest.approx(speed)
    word = next(word for word in feed.replace("/", ",").split(",") if word.isalpha() and word != "FEDRAT")
    assert program.reading == (f"lengths are in {unit}, by FEDRAT/{word} in line 8",)


@pytest.mark.parametrize("comment", COMMENTS)
def test_a_comment_says_the_unit_of_a_file_without_units(comment):
    program, codes, _ = found(text(comment))
    assert codes == ["L410"]
    assert_in(program, COMMENTS[comment])
    assert program.feed[1] == pytest.approx(MM[COMMENTS[comment]])


@pytest.mark.parametrize("units, feed", list(itertools.product(UNITS, FEEDS)))
def test_units_go_before_the_unit_of_a_feed_which_keeps_its_own(units, feed):
    unit, speed = FEEDS[feed]
    for lines in ((units,), ("PAINT/PATH", units)):  # after the tool and the frame, which are in this unit as well
        program, codes, _ = found(text(*lines, feed=feed))
        assert_in(program, UNITS[units])
        assert program.feed[1] == pytest.approx(speed)
        assert codes == ([] if unit == UNITS[units] else ["L410"])
        assert program.reading == ()


@pytest.mark.parametrize("one, other", list(itertools.combinations([*FEEDS, *COMMENTS], 2)))
def test_words_that_disagree_say_nothing(one, other):
    units = {FEEDS[word][0] if word in FEEDS else COMMENTS[word] for word in (one, other)}
    lines = [word for word in (one, other) if word in COMMENTS]
    feeds = [word for word in (one, other) if word in FEEDS] or ["FEDRAT/PERMIN,60"]
    program, codes, _ = found(text(*lines, feed="\n".join(feeds)))
    assert codes == (["L410"] if len(units) == 1 else ["L431"])
    assert (program is None) == (len(units) == 2)


@pytest.mark.parametrize("feed", ["FEDRAT/PERMIN,60", "FEDRAT/60", "SPINDL/300,SFM,CLW\nFEDRAT/60"])
def test_without_any_word_the_file_is_refused(feed):
    program, codes, diagnostics = found(text(feed=feed))
    assert program is None and codes == ["L431"]
    assert "--unit mm or --unit inch" in str(errors(diagnostics)[0])


SAYING = [None, *FEEDS, *COMMENTS, *UNITS]


@pytest.mark.parametrize("option, word", list(itertools.product(MM, SAYING)))
def test_the_option_goes_before_all_words(option, word):
    lines = [word] if word in UNITS or word in COMMENTS else []
    program, codes, _ = found(text(*lines, feed=word if word in FEEDS else "FEDRAT/PERMIN,60"), units=option)
    assert codes == []
    assert_in(program, option)
    assert program.reading == (f"lengths are in {option}, as the option says",)
    if word not in FEEDS:
        assert program.feed[1] == pytest.approx(MM[option])


@pytest.mark.parametrize(
    "option, units, feed, speed",
    [
        ("mm", "UNITS/INCHES", "FEDRAT/60,IPM", 1.0),  # a file in mm that says inches, as there are
        ("inch", "UNITS/MM", "FEDRAT/6,MMPM", 2.54),
        ("mm", "UNITS/MM", "FEDRAT/6,IPM", 2.54),  # the option agrees with the file: each word is as it says
        ("mm", "UNITS/INCHES", "FEDRAT/60,MMPM", 1.0),
        ("inch", "UNITS/INCHES", "FEDRAT/60,MMPM", 1.0),
        ("mm", "PAINT/PATH", "FEDRAT/60,IPM", 1.0),
        ("inch", "PAINT/PATH", "FEDRAT/6,IPM", 2.54),
    ],
)
def test_the_option_replaces_the_unit_of_the_file_in_feeds(option, units, feed, speed):
    program, _, _ = found(text(units, feed=feed), units=option)
    assert program.feed[1] == pytest.approx(speed)


def test_words_behind_the_end_say_nothing():
    late = "END-OF-PATH\nFINI\nFEDRAT/IPM,6\nUNITS/INCHES\n"
    program, codes, _ = found(text(feed="FEDRAT/MMPM,60").replace("END-OF-PATH\n", late))
    assert codes == ["L410", "L415"]
    assert_in(program, "mm")


def test_a_feed_within_a_cycle_says_the_unit():
    drilled = NX + "LOAD/TOOL,1\nGOTO/1,0,2\nCYCLE/DRILL,FEDTO,-1,IPM,6,RAPTO,.1\nGOTO/1,0,0\nCYCLE/OFF\n"
    program, codes, _ = found(drilled)
    assert codes == ["L410"]
    assert program.position[:, 2].min() == pytest.approx(-25.4)
    assert np.nanmax(program.feed) == pytest.approx(2.54)
    assert program.tools[1].diameter == pytest.approx(12.7)


@pytest.mark.parametrize("comment", COMMENTS)
def test_a_comment_with_another_letter_says_nothing(comment):
    for place in [at for word in re.finditer(r"units?\b|\w+\W*$", comment, re.I) for at in range(*word.span())]:
        if comment[place].isalpha():
            spoiled = comment[:place] + "q" + comment[place + 1 :]
            assert found(text(spoiled))[1] == ["L431"], spoiled


@pytest.mark.parametrize("comment", ["$$ the unit of the magazine is in line 4", "$$ tool of one inch", "$$ MM UNITS"])
def test_other_comments_say_nothing(comment):
    assert found(text(comment))[1] == ["L431"]


def test_lengths_in_inches_by_a_feed_are_measured_as_well():
    program, codes, _ = found(text(feed="FEDRAT/IPM,6").replace("GOTO/5,0,0", "GOTO/200,0,0\nGOTO/5,0,0"))
    assert codes == ["L410", "L410"]
    assert program.position[1, 0] == 200 * 25.4
