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
    assert found["after_undo"] == "worst check"
    assert found["verdict"] == ["The machine can follow the job", True]
    assert found["posed"] and found["posed at rest again"]
    assert found["seen"] == pytest.approx([0.0] * 3, abs=1e-2)  # Coin counts in single precision


def test_a_place_is_found_previewed_and_taken(session):
    found = session["a_place_is_found"]
    assert found["before"] == ["The machine cannot follow the job", False] and not found["take is shown at first"]
    assert found["text"].startswith("shift -") and "to spare" in found["text"]
    assert ": reaches, " in found["amounts"]
    assert found["posed"] and "--work-offset=600,0,200,10" in found["unchanged"]
    assert session.drew("place.png")
    assert found["after"] == ["The machine can follow the job", True] and found["reachable"]
    assert found["arguments"].count("--work-offset") == 1 and "600" not in found["arguments"]
    assert found["moved"] == pytest.approx([0.0] * 3, abs=1e-6)
    assert "--work-offset=600,0,200,10" in found["after undo"][0] and not found["after undo"][1]


def test_reach_says_in_red_what_posting_would_refuse(session):
    found = session["reach_of_a_collision"]
    assert found["posting"] == found["rows"] != []
    assert found["verdict"] == ["The machine cannot follow the job", False]
    assert found["selected"] == ["Cut"] and found["reported"].startswith("Cut, ")
    assert session.drew("collision.png")
    assert session.drew("reach.png")
