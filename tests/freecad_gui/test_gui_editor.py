# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program editor in a FreeCAD with a window."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("editor")


def test_program_is_opened_with_its_path_and_the_block_under_the_cursor(session):
    found = session["program_is_opened_and_its_editor_shows_a_block"]
    assert (found["moves"], found["view"], found["title"]) == (5, "ProgramView", "program.ngc - PKM Post")
    assert (found["findings"], found["coloured"]) == ([], 9)  # an empty line has no colour
    # mm: down 25, hypot(10, 4) along, half a circle of radius 5, up 25
    assert found["size"] == "5 blocks, 1 arcs, 76.5 mm"
    assert (found["drawn"], found["points"]) == (1, 61)  # half a turn in steps of 3 degrees
    assert session.drew("editor.png")


def test_editor_finds_planted_errors(session):
    found = session["editor_finds_planted_errors_while_they_are_typed"]
    assert [text.split()[:2] for text in found["findings"]] == [["6:5", "G102"], ["8:4", "G201"]]
    assert found["underlined"] == ["1..5", "Q"]
    assert (found["jumped"], found["after_undo"]) == (8, [])


def test_editor_replaces_renumbers_and_saves(session):
    found = session["editor_replaces_renumbers_and_saves"]
    assert found["found"] == [6, 7, 6]
    assert (found["replaced"], found["title"], found["saved"]) == (2, "program.ngc * - PKM Post", True)
    assert found["text"].startswith("N10 G21 G90 G17\nN20 T1 M6\n")
    assert found["ys"] == [0.0, 8.0]


def test_editor_colours_only_the_lines_in_sight(session):
    found = session["editor_colours_the_lines_in_sight_of_a_large_file"]
    assert (found["out_of_sight"], found["in_sight"]) == (0, 7)  # GOTO / 1 , 2 , 3
    assert (found["size"], found["back"]) == ("19998 blocks, 0 arcs, 0.0 mm", True)


def test_editor_decodes_into_a_job_and_posts(session):
    found = session["editor_decodes_and_posts"]
    assert found["decoded"] == ["program", 1, 0]
    assert {"program.pmc", "program.pkmt", "program-report.json"} <= set(found["files"])
    assert "program.pmc" in found["messages"][0]
