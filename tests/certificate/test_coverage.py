# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import pytest

from pkm_post.certificate.coverage import coverage
from pkm_post.machine_file import find_machine, read_machine
from pkm_post.model.certificate import Extent, Topic, meaning


def example():
    machine, faults = read_machine(find_machine("example_6tps"))
    assert not faults
    return machine


def extents(machine, topic):
    return {row.subject: row.extent for row in coverage(machine) if row.topic is topic}


def test_every_topic_is_one_line_and_every_hazard_stands_in_it_once():
    rows = coverage(example())
    lines = meaning(rows)
    assert [line.split(":")[0] for line in lines] == [topic.value for topic in Topic]
    for row in rows:
        assert [row.subject in line for line in lines].count(True) == 1, row


@pytest.mark.parametrize(
    ("left_out", "uncovered"),
    [
        ({"tube_radius": 0.0, "rod_radius": 0.0}, {"strut and strut", "strut and platform", "strut and fixture"}),
        ({"bodies": ()}, {"strut and platform", "spindle and fixture"}),
        ({"fixtures": ()}, {"strut and fixture", "spindle and fixture"}),
    ],
)
def test_bodies_that_the_machine_file_does_not_state_are_not_covered(left_out, uncovered):
    before = extents(example(), Topic.COLLISIONS)
    after = extents(replace(example(), **left_out), Topic.COLLISIONS)
    assert all(before[subject] is Extent.PROVEN for subject in uncovered)
    assert {subject for subject in before if before[subject] is not after[subject]} == uncovered
    assert all(after[subject] is Extent.NOT_COVERED for subject in uncovered)


def test_a_row_of_each_extent_is_named_with_it():
    (first, *_), (last, *_) = (
        [row for row in coverage(example()) if row.topic is topic] for topic in (Topic.PATH, Topic.SETUP)
    )
    lines = meaning((first, replace(first, extent=Extent.SAMPLED, subject="a sample"), last))
    assert lines[0] == f"tool path: proven: {first.subject}; sampled: a sample"
    assert lines[-1] == f"machine and set-up: not covered: {last.subject}"
