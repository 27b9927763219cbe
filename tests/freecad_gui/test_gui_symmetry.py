# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of mirrored and turned operations in a FreeCAD with a window.

The path is a quarter of a ring of radius 60 about z, cut counterclockwise with the spindle turning clockwise.
"""

import pytest

SIX_DECIMALS = 1e-6


@pytest.fixture(scope="module")
def session(scene):
    return scene("symmetry")


def test_mirror_is_made_and_edited_in_one_step_of_undo(session):
    found = session["mirror_from_its_button"]
    assert found["open"]
    assert found["closed"]
    assert (found["normal"], found["point"], found["keeps"]) == ([1, 0, 0], [5, 0, 0], True)
    assert found["undo steps"] == 1
    assert found["after undo"] == ["Cut"]
    assert found["after redo"] == [["Cut", "Mirror of Cut"], True]
    assert session.drew("mirror_panel.png")


def test_panel_offers_the_planes_and_tells_what_changes(session):
    found = session["mirror_from_its_button"]
    assert (found["choices"], found["chosen"]) == (["XY", "XZ", "YZ", "Picked", "Typed in"], "XZ")
    assert found["report"].startswith("Climb or conventional is unknown")
    assert found["computed later"]
    # Material to the left with M3 is conventional; the plane is 5 mm into a quarter that begins at x = 0.
    assert found["cuts"] == ["Conventional", "Conventional"]
    assert found["live report"].splitlines()[:4] == [
        "Original: conventional milling",
        "Copies: conventional milling",
        "Reversed passes: 1",
        "Both cut over a width of 10.00 mm",
    ]


def test_cancel_takes_a_new_operation_back(session):
    found = session["cancel_takes_a_new_one_back"]
    assert found == {"inside": ["Cut", "Rotation of Cut"], "after": ["Cut"], "undo": 0, "open": False}


def test_cancel_and_undo_after_a_double_click_bring_the_old_plane_back(session):
    found = session["edit_by_double_click"]
    assert (found["inside"], found["rejected"], found["undo"]) == ([0, 0, 1], [0, 1, 0], 0)
    assert (found["accepted"], found["undo steps"], found["undone"]) == ([1, 1, 0], 1, [0, 1, 0])
    assert found["no direction"] == [0, 1, 0]  # as before
    assert not found["open"]


def test_plane_is_picked_and_followed(session):
    found = session["plane_by_a_picked_face_and_a_datum_plane"]
    assert found["hint"] == "Pick a flat face or a datum plane"
    assert found["unfit"] == "Plane: expected a flat face or a datum plane, got Stock Edge1"
    assert found["face"] == "Stock Face2"
    point, normal = found["plane of face"]
    assert (point[0], normal) == (20, [1, 0, 0])
    assert (found["datum"], found["link"]) == ("Datum", "Datum")
    assert found["plane of datum"] == [[0, 7, 0], [0, 1, 0]]
    assert found["itself"] == "It depends on this operation"
    assert found["follows"] == 9


def test_a_panel_that_another_edit_closes_watches_no_longer(session):
    found = session["another_edit_leaves_nothing_behind"]
    assert found == {"panel": False, "dialog": False, "picks": 0, "open": False}


def test_fields_keep_the_decimals_that_they_do_not_show(session):
    found = session["fields_keep_decimals_that_they_do_not_show"]
    for name in ("PkmMirror 3", "PkmRotation 3", "PkmMirror 7", "PkmRotation 7"):  # inches, and feet with 70°44′7″
        assert found[name] == [1.23456, 2.34567, 0.12345, 1.23456, pytest.approx(25.4), 0.12345]
    assert (found["angle"], found["normal"]) == (0, [0.6, 0.8, 0])


def test_turns_by_number_and_by_list(session):
    found = session["turns_with_their_report"]
    half, three, listed = (found[name] for name in ("half turn", "three quarters", "list report"))
    assert "180.00° covered, 0.00° covered twice, widest gap 90.00°" in half
    assert "the tool is lifted between them" in half and "sector" in half  # what it means, and a cure
    assert "full circle, no overlap" in three
    assert "(4): tips 0.00 mm apart, tool axes by 0.00°" in three
    assert (found["no list"], found["no number"]) == ([[], ""], [])
    (square, radian), shown = found["list"]
    assert (square, radian) == (90, pytest.approx(57.29578, abs=SIX_DECIMALS)) and shown == "90; 57.29577951"
    assert found["list again"] == [square, radian]  # the text hides digits, which stay
    assert "180.00° covered, 90.00° covered twice" in listed
    assert found["axis of edge"] == [0, 0, 1]
    assert (found["copies"], found["angle"]) == (3, 90)
    assert session.drew("rotation_panel.png")


def test_a_mirror_of_a_rotation_reports_the_whole_family(session):
    found = session["mirror_of_a_rotation_and_the_whole_family"]
    assert found["label"] == "Mirror of Rotation of Cut"
    for report in (found["report"], found["other"]):
        assert "Cut with all its copies in the job, 4 in number: full circle, no overlap" in report
