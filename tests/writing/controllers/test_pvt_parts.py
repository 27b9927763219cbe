# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from dataclasses import replace

import numpy as np
import pytest
from strut_motions import read_back, with_rests

from pkm_post.model import Event, EventKind
from pkm_post.writing.controllers.pmac import program_parts
from pkm_post.writing.controllers.pvt.parts import headings, join_motions, split_motion, stated_part


@pytest.mark.parametrize("cuts", [(), (10,), (30, 40, 90)])
def test_parts_joined_are_the_whole(cuts):
    events = [Event(row, EventKind.DWELL, row / 8) for row in (0, 10, 10, 30, 55, 100)]
    motion = with_rests(5, 101, events)
    parts = split_motion(motion, cuts)
    assert len(parts) == len(cuts) + 1
    assert all(part.time_ms[0] == 0 for part in parts)
    whole, faults = join_motions(parts, [f"part{number}" for number in range(len(parts))])
    assert faults == ()
    assert all(np.array_equal(getattr(whole, name), getattr(motion, name)) for name in ("time_ms", "length", "speed"))
    assert whole.events == motion.events


def test_a_part_states_which_it_is_and_a_whole_program_does_not():
    assert list(headings(["job"], 1)) == [["job"]]
    for number, heading in enumerate(headings(["job"], 12), start=1):
        for mark in (";", "//"):
            text = "".join(f"{mark} {line}\n" for line in heading) + "CLOSE\n"
            assert stated_part(text) == (number, 12)
    assert stated_part(f"; part 1 of {'9' * 5000}: a lie\nCLOSE\n") == (1, 1)
    assert stated_part("; about part 1 of 2: a job\nCLOSE\n") == (1, 1)
    assert stated_part("; job\nCLOSE\n; part 2 of 3: of another\n") == (1, 1)


def test_parts_of_a_program_that_do_not_belong_together_are_found(settings):
    motion = with_rests(10, 101)
    small = replace(settings, memory_words=600)
    texts = program_parts(motion, small, [])
    assert len(texts) == 3
    for wrong in (texts[:1], texts[:2], texts[1:], texts[::-1], (texts[0], texts[2], texts[1]), (*texts, texts[2])):
        read, faults = read_back(wrong, small)
        assert read is None
        assert {fault.code for fault in faults} == {"C105"}


def test_parts_that_do_not_meet_are_found(settings):
    small = replace(settings, memory_words=600)
    one, _, three = program_parts(with_rests(10, 101), small, [])
    first_length = re.search(r"^A(\d+\.\d+) B", three, re.MULTILINE)[1]
    moved = three.replace(f"A{first_length} B", f"A{float(first_length) + 0.001:.6f} B", 1)
    two_parts = [one.replace("of 3", "of 2"), moved.replace("part 3 of 3", "part 2 of 2")]
    read, faults = read_back(two_parts, small)
    assert read is None
    assert [(fault.code, fault.place.file) for fault in faults] == [("C105", "part2")]
    assert "from where the part before it ended" in faults[0].found


def test_a_part_that_ends_in_motion_is_found(settings):
    small = replace(settings, memory_words=600)
    texts = list(program_parts(with_rests(10, 101), small, []))
    texts[0] = re.sub(r":0\.0000\nDWELL0\nLINEAR", ":0.0001\nDWELL0\nLINEAR", texts[0])
    assert [fault.found for fault in read_back(texts, small)[1]] == ["the part before it does not end at rest"]
