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
    in_sight, is_one_line = found["in sight"]
    assert in_sight.startswith("line 2, feed") and "left" in in_sight and is_one_line
    assert found["grey"] == [
        *["(the play is not waiting)"] * 2,
        *["(a trajectory is played)"] * 2,
        "(no posting with the blocks after / skipped was opened)",
        *["(a trajectory is played)"] * 3,
    ]
    assert found["held"] == [True, True]
    is_held, activity = found["activity"]
    assert is_held == ("a program is held" in activity)
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
    assert "C207" in found["refused"] and not found["plays"] and found["repeats"] == [True, False]
    assert "ended from elsewhere" in found["ended"] or "Ended by the operator" in found["ended"]
    assert found["running"] == [False, True] and found["left"] > 1.0


def test_the_tool_is_retracted_and_comes_back(session):
    found = session["the_tool_is_retracted_and_comes_back"]
    assert found["up"] == pytest.approx([0, 0, 15], abs=NEAR_MM)
    assert "the tool is 15 mm above its path" in found["said"] and "Played to the end" in found["ended"]
    assert "no retract: " in found["refused"]
    assert found["tip"] == pytest.approx([0, 0, 300], abs=NEAR_MM)


def test_blocks_behind_a_slash_are_skipped(session):
    found = session["blocks_behind_a_slash_are_skipped"]
    assert found["before"] == [False, "(no posting with the blocks after / skipped was opened)"]
    fault, files, is_none = found["not a trajectory"]
    assert "error T1" in fault and not files and is_none
    (skipped, _), (all_of_them, _) = found["lines"]
    assert not {3, 4} & set(skipped) and {3, 4} <= set(all_of_them)


def test_a_dry_run_without_a_feed_is_refused(session):
    refused = [["Not sent: the speed must be above zero"], True]
    assert session["a_dry_run_without_a_feed_is_refused"]["refused"] == [refused, refused]


def test_offsets_of_the_machine_are_those_of_the_play(session):
    found = session["offsets_of_the_machine_are_those_of_the_play"]
    assert (found["tools"], found["length"]) == (["T0"], 120)
    assert found["waits"].startswith("T0, 110 mm long") and "Played to the end" in found["ended"]
    # The part of the posting has gone by (2, -3); the panel takes the tool to be 10 mm longer than it was said to be.
    assert found["tip"] == pytest.approx([2, -3, 290], abs=NEAR_MM)
    assert found["reset"][1], found["reset"]


def test_a_clamp_on_the_way_to_a_line_is_refused(session):
    found = session["a_clamp_on_the_way_to_a_line_is_refused"]
    assert found["shown"] == "clamp.stl" and "K133" in found["refused"] and found["stands"] < NEAR_MM
    text, rests = found["no file"]
    assert "no.stl" in text and "error" in text and rests


def test_a_stop_while_it_is_prepared_comes_first(session):
    assert not session["a_stop_while_it_is_prepared_comes_first"]["plays"]
