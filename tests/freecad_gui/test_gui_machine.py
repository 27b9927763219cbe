# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine, Reach and the player in a FreeCAD with a window."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("machine")


def test_machine_is_made_for_a_job_and_moves_with_its_pose(session):
    found = session["machine_from_its_button"]
    assert (found["alone"], found["undone"]) == (True, True)
    assert (found["job"], found["icon"], found["out_of_limits"]) == ("Job", "machine.svg", [])
    assert found["moved"] == pytest.approx(100.0, abs=1e-3)  # Coin counts in single precision
    assert any(red > 0.8 and green < 0.2 for red, green, _ in found["red"])
    assert (found["scene_without_machine"], found["scene"]) == (False, True)


def test_reach_is_coloured_and_its_panel_shows_where(session):
    found = session["reach_from_its_button"]
    assert (found["machine"], found["reachable"], found["nodes"]) == ("Machine", True, 3)
    assert (found["rows"], found["colour_by"], found["selected"]) == (True, "base joints", True)
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == "shortest struts"
    assert session.drew("reach.png")


def test_simulation_plays_steps_scrubs_and_stops_at_problems(session):
    found = session["simulation_from_its_button"]
    assert "Arcs, line" in found["told"]
    assert 0.5 < found["played"] <= found["duration"]
    assert found["stepped"]
    assert found["scrubbed"] == 4.0
    assert found["machine_is_there"]
    assert found["pictures"][:2] == ["frame_00001.png", "frame_00002.png"]
    assert found["machine_is_back"]
    assert "joint" in found["problem"] or "strut" in found["problem"]
    assert found["stopped_at"]
    assert (found["closed_with_its_machine"], found["closed_with_its_document"]) == (True, True)
