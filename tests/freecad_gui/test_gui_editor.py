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
    assert found["size"] == "5 blocks, 1 arcs, 76.48 mm"
    assert (found["drawn"], found["points"]) == (1, 61)  # half a turn in steps of 3 degrees
    assert session.drew("editor.png")


def test_editor_finds_planted_errors(session):
    found = session["editor_finds_planted_errors_while_they_are_typed"]
    assert [text.split()[:2] for text in found["findings"]] == [["6:5", "G102"], ["8:4", "G201"]]
    assert found["underlined"] == ["1..5", "Q"]
    assert (found["jumped"], found["after_undo"]) == (8, [])
    over, beside = found["tool_tips"]
    assert over.startswith("G102 a number is malformed: '1..5'; write it as")
    assert beside == ""


def test_editor_replaces_renumbers_and_saves(session):
    found = session["editor_replaces_renumbers_and_saves"]
    assert found["found"] == [6, 7, 6]
    assert found["backwards"] == 7
    assert (found["replaced"], found["title"], found["saved"]) == ("2 replaced", "program.ngc * - PKM Post", True)
    assert found["refused"] == ["Not renumbered: line 10 jumps to a block by its number", 10, True]
    assert found["text"].startswith("N10 G21 G90 G17\nN20 T1 M6\n")
    assert found["ys"] == [0.0, 8.0]


def test_editor_colours_only_the_lines_in_sight(session):
    found = session["editor_colours_the_lines_in_sight_of_a_large_file"]
    assert (found["out_of_sight"], found["in_sight"]) == (0, 7)  # GOTO / 1 , 2 , 3
    assert (found["size"], found["back"]) == ("19998 blocks, 0 arcs, 0 mm", True)


def test_siemens_language_has_its_colours(session):
    found = session["editor_shows_siemens_language_in_colours_of_its_own"]
    assert (found["colours"], found["back"]) == ([found["expected"]], True)


def test_100000_lines_are_loaded_and_changed_in_slices_and_undone_in_one_step(session):
    found = session["editor_leaves_the_window_its_turns_in_100000_lines"]
    print("widest gaps between two turns of the window, ms by the clock and of the processor:", found["gaps"])
    assert found["in slices"] == ["open", "replace all", "renumber", "undo", "redo", "undo again", "undo replacing"]
    assert found["opened"]
    assert found["replaced"] == [2, "G1 X7.5 Y0.0"]
    assert found["numbered"] == ["N10 G21 G90 G17", "N1000000 G1 X49.4 Y19.9"]
    assert (found["undone"], found["redone"]) == ([True, True], True)
    assert found["saved"] == [100001, "G1 X1"]


def test_editor_asks_what_cl_data_leaves_open(session):
    found = session["editor_asks_what_cl_data_leaves_open"]
    assert found["offered"] == [[False, True], [True, False]]
    assert found["codes"] == [["L411", "L431", "L429"], ["L411", "L429"], ["L411"]]
    assert found["reading"] == [
        "lengths are in mm, as the option says",
        "CUTCOM in line 7: points are the contour of the part, as the option says",
    ]
    assert found["after"] == [None, None]


def test_editor_asks_who_wrote_cl_data(session):
    found = session["editor_asks_who_wrote_cl_data"]
    assert found["codes"] == [["L419"], ["L411"]]
    assert found["posted"]
    assert found["after"] is None


def test_editor_shows_a_program_without_an_end_and_takes_it_where_it_may(session):
    found = session["editor_asks_whether_a_program_may_have_no_end"]
    assert found["codes"] == [["G430"], ["V130"]]
    assert (found["size"], found["after"]) == ("5 blocks, 1 arcs, 76.48 mm", False)


def test_editor_opens_a_part_program_that_is_dropped_among_other_files(session):
    found = session["editor_opens_what_is_dropped"]
    assert found["text"] == "G0 X1 Y2 Z3\n"
    assert {"Ctrl+O", "Ctrl+S", "Ctrl+F", "F3", "Shift+F3"} <= set(found["keys"])


def test_editor_keeps_reading_options_with_their_text(session):
    found = session["editor_keeps_reading_options_with_their_text"]
    of_the_object, of_another_file, of_the_text_renamed = found["reported"]
    assert of_the_object == [True, ["G55"]]
    assert of_another_file == [False, []]  # nothing unseen
    assert of_the_text_renamed == [True, "inch"]
    # inch: as in mm above, times 25.4
    assert (found["findings"], found["size"]) == ([], "5 blocks, 1 arcs, 1943 mm")


def test_editor_shows_its_context_menu(session):
    assert {"edit-undo", "edit-redo", "edit-copy"} <= set(session["editor_shows_its_context_menu"]["shown"])


def test_editor_decodes_into_a_job_and_posts(session):
    found = session["editor_decodes_and_posts"]
    assert found["decoded"] == ["program", 1, 0]
    assert {"program.pmc", "program.pkmt", "program-report.json"} <= set(found["files"])
    assert "program.pmc" in found["messages"][0]
