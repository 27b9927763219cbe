# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation and its player in a FreeCAD with a window."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("simulation")


def test_the_command_adds_one_object_in_one_step_and_opens_its_player(session):
    found = session["simulation_from_its_button"]
    assert (found["undone"], found["closed_by_undo"]) == (True, True)
    assert (found["machine"], found["icon"], found["count"], found["valid"]) == ("Machine", "simulate.svg", 1, True)
    assert found["plays"] == pytest.approx(found["duration"], abs=1e-6)
    assert found["opened_by_double_click"]


def test_the_player_plays_steps_and_scrubs(session):
    found = session["player_plays"]
    assert "Arcs, line" in found["reported"]
    assert 0.5 < found["played"] <= session["simulation_from_its_button"]["duration"]
    assert (found["stepped"], found["stepped_back"]) == (True, True)
    assert found["scrubbed"] == 4.0
    assert found["paged"] > 0.99
    assert found["arrows"] == []  # with them a tab would be out of sight
    assert found["machine_is_there"]
    assert session.drew("simulation.png")


def test_an_override_scales_time_and_speeds_and_tells_of_struts_too_slow_for_it(session):
    found = session["override_scales_time_and_speeds"]
    assert found["pace"] == 0.5
    assert found["curves_change"]
    assert ("At this override strut" in found["reported"]) == (2 * found["greatest"] > found["limit"])


def test_film_is_written_as_pictures_and_as_one(session):
    found = session["film_is_written"]
    assert found["pictures"] == [f"frame_{number:05d}.png" for number in range(1, found["written"] + 1)]
    # 10 times as fast, 2 pictures for each second of film: one for every 5 s, and 4 make one for every 2.5 s
    duration = session["simulation_from_its_button"]["duration"]
    assert (found["written"], found["played"]) == (int(duration / 5) + 1, int(duration / 2.5) + 1)
    film = (session.folder / "film.png").read_bytes()
    assert film.count(b"fcTL") == found["played"]


def test_a_click_on_an_operation_goes_to_its_beginning(session):
    found = session["operations_are_clicked"]
    assert (found["selected"], found["operation"]) == (["Tilted"], "Tilted")
    assert found["status"].startswith("Tilted, ")
    assert "G0" in found["status"]
    assert [line.split(":")[0] for line in found["lines"]] == ["Arcs", "Tilted"]


def test_the_player_follows_the_job_stops_at_problems_and_shows_where_they_are_worst(session):
    found = session["player_follows_the_job"]
    assert found["follows"]
    assert "joint" in found["problem"] or "strut" in found["problem"]
    assert (found["stopped_at"], found["listed"], found["at_its_worst"], found["selected"]) == (True, True, True, True)
    assert found["marked"] == 2
    assert session.drew("problems.png")


def test_cams_own_simulator_opens_with_the_same_job(session):
    found = session["cam_simulates_the_same_job"]
    assert found["opened"] == [True]
    assert found["jobs"] == ["Job"]


def test_the_player_goes_with_what_it_shows_and_gives_the_machine_back(session):
    found = session["nothing_is_left_open"]
    assert found["machine_is_back"]
    assert (found["closed_with_its_machine"], found["closed_with_its_document"]) == (True, True)
    assert "M101" in found["refused"][0]
    assert found["no_player"]
