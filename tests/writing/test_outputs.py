# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program for LinuxCNC's hexapod says of corners what the trajectory says."""

import dataclasses

from machines import example
from programs import BALL, ON_PALLET, program

from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.toolpath.place import place
from pkm_post.writing.outputs import left_over, linuxcnc_text


def test_stops_and_tolerances_of_the_trajectory_are_in_the_program_for_linuxcnc():
    made = program([[0, 0, 60], [9, 0, 60], [9, 9, 60], [0, 9, 60], [0, 0, 60]])
    reported = dataclasses.replace(
        made, exact_path=[False, True, False, False, False], tip_tolerance=[0, 0, 0, 0.05, 0]
    )
    trajectory, _ = place(reported, example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [True, True, False, False, True]
    text, faults = linuxcnc_text(trajectory, 0.001)
    assert not faults
    back, _ = read(text, "part.ngc", ReadOptions(axis_words="RPY", default_tool=BALL))
    assert back.exact_stop.tolist() == trajectory.exact_stop.tolist()
    assert back.tip_tolerance.tolist() == [0.0, 0.0, 0.001, 0.05, 0.0]  # exact stops have none


MADE = ["a-setup.pmc", "a.pkmt", "a.pmc"]
OF_BEFORE = [
    "a-halstreamer-part2.txt",
    "a-halstreamer.txt",
    "a-linuxcnc.ngc",
    "a-part2.pmc",
    "a-part13.pmc",
    "a-setup.cfg",
    "a.csv",
]
OF_OTHERS = [
    "a.ngc",
    "b.pmc",
    "b-part2.pmc",
    "a-partner.pmc",
    "a-part0.pmc",
    "xa-part2.pmc",
    "a-part2.pmc.bak",
    "a-notes.txt",
]


def test_what_an_earlier_result_left_is_named(tmp_path):
    for name in (*MADE, *OF_OTHERS):
        (tmp_path / name).touch()
    assert left_over(tmp_path / "a.pmc", MADE) == ()
    for name in OF_BEFORE:
        (tmp_path / name).touch()
    (warning,) = left_over(tmp_path / "a.pmc", MADE)
    assert (warning.code, warning.place.file) == ("F104", str(tmp_path / "a.pmc"))
    assert warning.found.split(", ") == sorted(OF_BEFORE)
    assert left_over(tmp_path / "a.pmc", [*MADE, *OF_BEFORE]) == ()


def test_a_name_may_have_what_patterns_are_made_of(tmp_path):
    for name in ("a+(b).pmc", "a+(b)-part2.pmc", "aab-part2.pmc"):
        (tmp_path / name).touch()
    (warning,) = left_over(tmp_path / "a+(b).pmc", ["a+(b).pmc"])
    assert warning.found == "a+(b)-part2.pmc"
