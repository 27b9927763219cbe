# SPDX-License-Identifier: LGPL-2.1-or-later
"""The player in the panel of numerical control, in a FreeCAD with a window, before a simulated machine."""

import pytest

NEAR_MM = 1e-3


@pytest.fixture(scope="module")
def session(scene):
    return scene("control_play")


def test_a_posted_trajectory_is_opened(session):
    found = session["a_posted_trajectory_is_opened"]
    assert found["before"] == [False, "(no trajectory was opened)", "no trajectory was opened"]
    assert "error T1" in found["not a trajectory"][0] and not found["not a trajectory"][1]
    assert (found["opened"], found["end"], found["on"]) == ("slow.pkmt", False, False)


def test_it_is_played_slowed_held_and_resumed_and_nothing_moves_under_the_hand(session):
    found = session["it_is_played_slowed_held_and_resumed"]
    assert (found["jog"], found["reads"]) == (False, True)
    place, speeds, override = found["said"]
    assert place.endswith("line 2") and "to go" in speeds and "mm/s" in speeds and not override
    assert found["held"][:2] == [True, True] and "a program is held" in found["held"][2]
    assert found["override 0"] == [False, True] and found["stands"]
    said = "\n".join(found["messages"])
    assert "Played to the end: " in said and "deviation of the tool tip: " in said
    assert found["tip"] == pytest.approx([0, 0, 300], abs=NEAR_MM) and found["play"]
    assert session.drew("play.png")


def test_single_block_rests_at_each_line_and_a_line_is_begun_at(session):
    found = session["single_block_rests_at_each_line_and_a_line_is_begun_at"]
    tool, *lines = found["waits"]
    assert tool.startswith("T0, 120 mm long")
    assert [line for line, _ in lines] == [4, 5]  # what comes next
    assert lines[0][1] == pytest.approx([20, 10, 300], abs=NEAR_MM)
    assert lines[1][1] == pytest.approx([0, 10, 300], abs=NEAR_MM)
    assert found["tip"] == pytest.approx([0, 0, 300], abs=NEAR_MM)


def test_a_line_that_is_not_there_is_refused_and_an_abort_ends_a_play(session):
    found = session["a_line_that_is_not_there_is_refused_and_an_abort_ends_a_play"]
    assert "C207" in found["refused"] and not found["plays"]
    assert "ended from elsewhere" in found["ended"] or "Ended by the operator" in found["ended"]
    assert found["running"] == [False, True] and found["left"] > 1.0
