# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations from their buttons in a FreeCAD with a window."""

import numpy as np
import pytest
from matplotlib.image import imread


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
    assert (found["stepover_shown"], found["accepted"], found["passes"]) == (1.0, 2.0, 5)
    assert found["rejected"] == 2.0
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == 0


def test_escape_stops_a_long_computation_in_a_recompute_and_outside(session):
    found = session["escape_stops_a_long_computation"]
    for reported in (found["inside a recompute"], found["alone"]):
        assert reported.startswith("Waiting")
        assert 20 <= int(reported.split()[-1]) < 100


def test_escape_that_comes_after_the_last_step_is_taken_by_the_computation(session):
    assert session["escape_after_the_last_look_is_not_left_to_the_panel"]["taken"] == 1


def test_escape_stops_the_computing_and_never_deletes_the_operation(session):
    found = session["escape_pressed_twice_leaves_the_operation"]
    assert (found["operations"], found["open"]) == (1, True)
    assert len(found["stopped"]) == 1 and "stopped at" in found["stopped"][0]
    assert found["computed later"]


def test_the_map_of_a_reopened_document_comes_back_by_a_click(session):
    found = session["the_map_of_a_reopened_document_comes_back_by_a_click"]
    assert found["kept"] == pytest.approx(found["measured"], rel=1e-15, abs=0.0)  # FreeCAD saves 16 digits
    assert found["measured"][1] > 0.0 and found["offered"]
    assert found["before"][0].split("\n")[0] == found["after"][0].split("\n")[0]
    assert found["before"][0].startswith("No gouge: ") and ", between the points at most " in found["before"][0]
    assert found["map"] == 1 and session.drew("map_again.png")


def test_a_gouge_is_an_error_in_red_with_a_map_on_the_part(session):
    found = session["a_gouge_is_seen_on_the_part"]
    assert found["before"] == ["Not computed yet: Apply computes it", ""]
    # the mill is 5 mm wide and its axis comes to the wall: it is in it by its radius
    assert found["depth"] == pytest.approx(2.5, abs=0.01)
    text, colour = found["gouged"]
    assert colour == "red" and "N311" in text and "N311" in found["state"]
    assert (found["map"], found["left"]) == (1, 0)
    assert found["not looked for"] == ["Gouges are not checked: set a distance of check points", ""]
    assert session.drew("gouge.png") and has_red(session.folder / "gouge.png")


def has_red(path):
    """Whether the full red of the map covers more than what a mark does."""
    pixels = imread(path)[..., :3]
    near = np.abs(pixels - np.array([0.85, 0.0, 0.0])).max(axis=-1) < 0.06
    return near.sum() > 500
