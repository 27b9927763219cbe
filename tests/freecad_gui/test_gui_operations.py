# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations from their buttons in a FreeCAD with a window."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("operations")


def test_buttons_add_copies_with_their_views(session):
    found = session["mirror_and_rotate_from_their_buttons"]
    assert found["views"] == ["SymmetryView", "SymmetryView"]
    assert found["icons"] == ["mirror.svg", "rotate.svg"]
    assert all(moves > 3 for moves in found["moves"])


def test_one_undo_takes_one_copy_back(session):
    found = session["undo_takes_one_step_back"]
    assert (found["before"], found["after"]) == (3, 2)


def test_button_puts_normal_compensation_over_an_operation(session):
    found = session["normal_compensation_from_its_button"]
    assert (found["view"], found["icon"]) == ("NormalCompensationView", "normal_compensation.svg")
    assert (found["children"], found["moves"], found["base_is_shown"]) == (["Custom"], 4, False)
    assert (found["given_back"], found["base_is_shown_again"]) == (["Custom"], True)


def test_surface_finish_is_made_of_selected_faces_and_edited_in_cams_panel(session):
    found = session["surface_finish_from_its_button"]
    assert found["active"] == {"job": True, "face": True, "controller": True}  # each means the job
    assert (found["view"], found["icon"]) == ("SurfaceFinishView", "surface_finish.svg")
    assert (found["faces"], found["valid"]) == (["Face6"], True)
    assert found["panel_is_open"] and not found["computed"]  # not before the user applies it
    assert found["measured"] == 1.0
    assert (found["stepover_shown"], found["accepted"], found["passes"]) == (1.0, 2.0, 11)
    assert found["rejected"] == 2.0
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == 0


def test_escape_stops_a_long_computation_in_a_recompute_and_outside(session):
    found = session["escape_stops_a_long_computation"]
    for reported in (found["inside a recompute"], found["alone"]):
        assert reported.startswith("Waiting")
        assert 20 <= int(reported.split()[-1]) < 100


def test_escape_stops_the_computing_and_never_deletes_the_operation(session):
    found = session["escape_pressed_twice_leaves_the_operation"]
    assert (found["operations"], found["open"]) == (1, True)
    assert len(found["stopped"]) == 1 and "stopped at" in found["stopped"][0]
    assert found["computed later"]
