# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine and Reach in a FreeCAD with a window."""

import math

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
    assert (found["machine"], found["reachable"], found["nodes"]) == ("Machine", True, 4)
    assert (found["rows"], found["colour_by"], found["selected"]) == (True, "base joints", True)
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == "worst check"
    assert found["verdict"] == ["The machine can follow the job", True]
    assert found["posed"] and found["posed at rest again"]
    assert (found["axes"], found["no axes"]) == (1, 0)
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


def test_icons_of_job_and_operations_say_what_reach_found(session):
    found = session["icons_say_what_reach_found"]
    assert set(found["at first"].values()) == {""}
    assert set(found["all well"].values()) == {"good"}
    assert found["changed"] == {"bad": ""}
    assert found["out of reach"] == {"job": "bad", "good": "good", "bad": "bad", "reach": "bad"}
    assert set(found["without reach"].values()) == {""}
    assert found["refused"] == {"job": "bad", "good": "good", "bad": "bad"}
    assert set(found["mended"].values()) == {""}
    assert set(found["posted"].values()) == set(found["hidden"].values()) == {"good"}
    assert found["by a simulation"] == {"job": "bad", "good": "good", "bad": "bad"}
    assert session.drew("verdict_icons.png")


def test_icons_of_dressups_and_copies_say_it_too(session):
    found = session["icons_of_dressups_and_copies_say_it_too"]
    assert set(found["at first"].values()) == {""}
    copies = ("compensated", "mirrored", "turned")
    assert found["all well"] == {"base": ""} | dict.fromkeys(copies, "good")
    assert found["out of reach"] == {"base": ""} | dict.fromkeys(copies, "bad")
    assert set(found["with an error"].values()) == {""}
    assert found["panel"] == [f"{found['turned']} has an error", False]
    assert session.drew("verdict_dressups.png")


def test_a_double_click_on_the_machine_opens_a_jog_panel(session):
    found = session["jogged_after_a_double_click"]
    assert found["verdict"] == ["The machine can reach this pose", True] and found["fields"] == 6
    assert found["moved"] == pytest.approx([10.0, 0.0, 0.0])  # a step to the right, and a turn with the tip at rest
    assert found["axis"] == pytest.approx([math.sin(math.radians(5)), 0.0, math.cos(math.radians(5))])
    assert found["struts"][0] != pytest.approx(found["struts"][1])
    assert (found["far"], found["out"], found["words"]) == (900.0, False, True)
    assert found["followed"] == pytest.approx(900.0)  # the verdict is of the pose that the document has
    assert found["home"] == pytest.approx([0.0, 0.0, 0.0])
    assert found["back"] and found["closed"]
    assert session.drew("jog.png")


def test_stiffness_is_shown_over_job_and_table(session):
    found = session["stiffness_from_its_button"]
    assert found["summary"].startswith("Stiffness of the tool tip in the softest direction: ")
    assert [row.split(",")[0] for row in found["rows"]] == ["Arcs", "Tilted"]
    assert found["selected"] == ["Tilted"] and found["posed"] and found["posed at rest again"]
    assert (found["reach"], found["reach again"]) == ([-1, True], 0)
    assert found["nodes left"] == found["nodes left by another command"] == 0
    assert session.drew("stiffness.png")
