# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine and Reach in a FreeCAD with a window."""

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
