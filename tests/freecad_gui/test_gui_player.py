# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pages of the player in a FreeCAD with a window: material, readout, program, timeline."""

import math

import pytest


@pytest.fixture(scope="module")
def session(scene):
    made = scene("player")
    made.keep("material.png")
    made.keep("narrow.png")
    return made


def test_the_player_has_pages_bands_and_the_program(session):
    found = session["player_opens_with_its_pages"]
    assert found["tabs"][2:6] == ["Readout", "Program", "Material", "View"]
    assert found["bands"] == ["Groove", "Above"]
    assert found["tools"] == ["T2"]
    assert "(Groove)" in found["rows"] and "(Above)" in found["rows"]
    assert len(found["material"]) == 4


def test_a_tilted_end_mill_takes_what_geometry_says_and_it_comes_back(session):
    found = session["material_is_taken_and_comes_back"]
    assert found["whole"] == pytest.approx(20**3, rel=0.005)
    # below the top, between the bottom (30 degrees to the level) and the side of a tool of diameter 10 whose tip is 6
    # deep: the triangle above its lower corner, without the one above the other corner
    half = 5 * math.sin(math.radians(30))
    slopes = 1 / math.tan(math.radians(30)) + 1 / math.tan(math.radians(60))
    exact = 20 * slopes / 2 * ((6 + half) ** 2 - (6 - half) ** 2)
    assert found["whole"] - found["cut"] == pytest.approx(exact, rel=0.02)
    assert found["back"] == pytest.approx(found["whole"], rel=1e-6)
    assert found["hidden"] and found["kept"] and found["shown"]
    # the stock is the part here: all that was taken is missing, to the depth of the corner
    assert found["gouged"] == pytest.approx(found["whole"] - found["cut"], rel=0.03)
    assert found["left"] < 0.02 * found["gouged"]
    assert len(found["lines"]) == 3
    assert session.drew("material.png")


def test_the_readout_has_the_numbers_of_the_motion_and_the_program_is_marked(session):
    found = session["readout_and_program_go_together"]
    assert found["begins"] == pytest.approx(found["before"], abs=1e-6)
    assert found["marked"] == found["row"]
    numbers = [float(text.split()[0]) for text in found["texts"][:12]]
    assert numbers[:3] == pytest.approx(found["tip"], abs=0.01)
    assert numbers[3:6] == pytest.approx(found["axis"], abs=1e-5)
    assert numbers[6:12] == pytest.approx(found["lengths"], abs=0.01)
    assert found["texts"][14].startswith("Groove, ")


def test_the_readout_has_the_units_of_the_user(session):
    texts = session["readout_follows_the_units_of_the_user"]["texts"]
    assert all(text.endswith(('"', "in", "in/min", "ipm")) for text in (texts[0], texts[6], texts[12], texts[13]))
    assert session["readout_follows_the_units_of_the_user"]["times"] == ["0:59.9", "1:00.0", "1:00:00.0"]


def test_a_click_in_the_timeline_goes_there(session):
    found = session["timeline_goes_to_a_click"]
    assert found["at"] == pytest.approx(found["start"])
    assert "Above" in found["text"]


def test_parts_of_the_machine_are_shown_faded_and_hidden_each_by_itself(session):
    found = session["view_is_chosen"]
    for name in ("base", "struts", "platform", "tool"):
        (shown, *solid), (faded, *clear), (hidden, *_) = found[name]
        assert (shown, solid, faded, clear, hidden) == (True, [0.0], True, [0.7], False)


def test_the_view_has_tool_axes_follows_the_tool_and_is_cut_open(session):
    found = session["view_is_chosen"]
    children, axes, blocks = found["axes"]
    assert (children, axes) == (1, blocks // 2)
    assert found["followed"] and found["section"] and found["whole"] and found["no axes"]
    (kept, every, drawn), off = found["preference"]
    assert (kept, every, drawn, off) == (True, 3, 1, [True, 0, 0])


def test_bodies_that_come_too_close_are_red_until_they_part(session):
    found = session["bodies_that_come_too_close_are_red"]
    assert found["red"] == [2]
    assert found["tool"] == [0.85, 0.1, 0.1]
    assert found["after"] == [[0.62, 0.65, 0.7], [0.85, 0.65, 0.2]]


def test_a_film_says_time_operation_and_line(session):
    found = session["film_has_a_caption"]
    assert found["written"] >= 2
    assert found["ground"] and found["differ"] and min(found["light"]) > 5


def test_a_dock_of_380_pixels_hides_no_button(session):
    found = session["narrow_dock_hides_nothing"]
    assert found["width"] <= 400
    assert found["outside"] == []


def test_wrappers_of_deleted_widgets_at_the_same_address_do_not_end_freecad(session):
    found = session["player_closes_beside_stale_wrappers"]
    assert (found["stale"] > 100 and found["taken"] > 0) or found["qt"] < "6"
    assert found["closed"]


def test_fault_pages_close_beside_wrappers_of_deleted_widgets(session):
    found = session["fault_pages_close_beside_stale_wrappers"]
    assert found["stale"] > 100 or found["qt"] < "6"
    assert found["open"] == 0
