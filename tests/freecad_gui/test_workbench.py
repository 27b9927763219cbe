# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in a FreeCAD with a window, under Xvfb: one session, what it found is looked at here."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

ADDON = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gui")
    result, picture = folder / "result.json", folder / "window.png"
    window = shutil.which("freecad") or shutil.which("FreeCAD")
    assert window and shutil.which("xvfb-run"), "FreeCAD's window program and xvfb-run are needed"
    script = Path(__file__).with_name("session.py")
    command = ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24", window, "-M", str(ADDON), str(script)]
    files = {"PKM_RESULT": str(result), "PKM_SCREENSHOT": str(picture)}
    ran = subprocess.run(command, env=os.environ | files, capture_output=True, text=True, timeout=180, check=False)
    assert result.exists(), ran.stdout + ran.stderr
    return {"found": json.loads(result.read_text()), "log": ran.stdout + ran.stderr, "picture": picture}


def test_no_step_ended_in_an_exception(session):
    assert [found for found in session["found"].values() if "exception" in found] == []
    assert "Traceback" not in session["log"]


def test_workbench_has_its_commands(session):
    found = session["found"]["workbench_has_its_commands"]
    assert found["listed"]
    assert found["buttons"] == [
        "Mirror operation",
        "Rotate operation",
        "Normal Compensation",
        "Surface Finish (5-axis)",
        "Machine",
        "Reach",
        "Simulate",
        "Program editor",
        "Post to a hexapod",
    ]
    assert all(found["icons"])


def test_commands_are_active_for_what_they_are_for(session):
    found = session["found"]["commands_know_what_they_are_for"]
    assert found == {
        "job": [False, False, True],
        "operation": [True, True, False],
        "controller": [False, False, False],
    }


def test_buttons_add_copies_with_their_views(session):
    found = session["found"]["mirror_and_rotate_from_their_buttons"]
    assert found["views"] == ["SymmetryView", "SymmetryView"]
    assert found["icons"] == ["mirror.svg", "rotate.svg"]
    assert all(moves > 3 for moves in found["moves"])


def test_one_undo_takes_one_copy_back(session):
    found = session["found"]["undo_takes_one_step_back"]
    assert (found["before"], found["after"]) == (3, 2)


def test_button_puts_normal_compensation_over_an_operation(session):
    found = session["found"]["normal_compensation_from_its_button"]
    assert (found["view"], found["icon"]) == ("NormalCompensationView", "normal_compensation.svg")
    assert (found["children"], found["moves"], found["base_is_shown"]) == (["Custom"], 4, False)
    assert (found["given_back"], found["base_is_shown_again"]) == (["Custom"], True)


def test_surface_finish_is_made_of_selected_faces_and_edited_in_cams_panel(session):
    found = session["found"]["surface_finish_from_its_button"]
    assert found["active"] == {"job": True, "face": True, "controller": False}
    assert (found["view"], found["icon"]) == ("SurfaceFinishView", "surface_finish.svg")
    assert (found["faces"], found["valid"]) == (["Face6"], True)
    assert found["panel_is_open"]
    assert (found["stepover_shown"], found["accepted"], found["passes"]) == (1.0, 2.0, 11)
    assert found["rejected"] == 2.0
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == 0


def test_escape_stops_a_long_computation_in_a_recompute_and_outside(session):
    found = session["found"]["escape_stops_a_long_computation"]
    for told in (found["inside a recompute"], found["alone"]):
        assert told.startswith("Waiting")
        assert 20 <= int(told.split()[-1]) < 100


def test_machine_is_made_for_a_job_and_moves_with_its_pose(session):
    found = session["found"]["machine_from_its_button"]
    assert (found["alone"], found["undone"]) == (True, True)
    assert (found["job"], found["icon"], found["out_of_limits"]) == ("Job", "machine.svg", [])
    assert found["moved"] == pytest.approx(100.0, abs=1e-3)  # Coin counts in single precision
    assert any(red > 0.8 and green < 0.2 for red, green, _ in found["red"])
    assert (found["scene_without_machine"], found["scene"]) == (False, True)


def test_reach_is_coloured_and_its_panel_shows_where(session):
    found = session["found"]["reach_from_its_button"]
    assert (found["machine"], found["reachable"], found["nodes"]) == ("Machine", True, 3)
    assert (found["rows"], found["colour_by"], found["selected"]) == (True, "base joints", True)
    assert not found["panel_is_left_open"]
    assert found["after_undo"] == "shortest struts"
    assert (session["picture"].with_name("reach.png")).stat().st_size > 20_000


def test_simulation_plays_steps_scrubs_and_stops_at_problems(session):
    found = session["found"]["simulation_from_its_button"]
    assert "Arcs, line" in found["told"]
    assert 0.5 < found["played"] <= found["duration"]
    assert found["stepped"]
    assert found["scrubbed"] == 4.0
    assert found["machine_is_there"]
    assert found["pictures"][:2] == ["frame_00001.png", "frame_00002.png"]
    assert found["machine_is_back"]
    assert "joint" in found["problem"] or "strut" in found["problem"]
    assert found["stopped_at"]
    assert (found["closed_with_its_machine"], found["closed_with_its_document"]) == (True, True)


def test_program_is_opened_with_its_path_and_the_block_under_the_cursor(session):
    found = session["found"]["program_is_opened_and_its_editor_shows_a_block"]
    assert (found["moves"], found["view"], found["title"]) == (5, "ProgramView", "program.ngc - PKM Post")
    assert (found["findings"], found["coloured"]) == ([], 9)  # an empty line has no colour
    # mm: down 25, hypot(10, 4) along, half a circle of radius 5, up 25
    assert found["size"] == "5 blocks, 1 arcs, 76.5 mm"
    assert (found["drawn"], found["points"]) == (1, 61)  # half a turn in steps of 3 degrees
    assert session["picture"].with_name("editor.png").stat().st_size > 20_000


def test_editor_finds_planted_errors(session):
    found = session["found"]["editor_finds_planted_errors_while_they_are_typed"]
    assert [text.split()[:2] for text in found["findings"]] == [["6:5", "G102"], ["8:4", "G201"]]
    assert found["underlined"] == ["1..5", "Q"]
    assert (found["jumped"], found["after_undo"]) == (8, [])


def test_editor_replaces_renumbers_and_saves(session):
    found = session["found"]["editor_replaces_renumbers_and_saves"]
    assert found["found"] == [6, 7, 6]
    assert (found["replaced"], found["title"], found["saved"]) == (2, "program.ngc * - PKM Post", True)
    assert found["text"].startswith("N10 G21 G90 G17\nN20 T1 M6\n")
    assert found["ys"] == [0.0, 8.0]


def test_editor_colours_only_the_lines_in_sight(session):
    found = session["found"]["editor_colours_the_lines_in_sight_of_a_large_file"]
    assert (found["out_of_sight"], found["in_sight"]) == (0, 7)  # GOTO / 1 , 2 , 3
    assert (found["size"], found["back"]) == ("19998 blocks, 0 arcs, 0.0 mm", True)


def test_editor_decodes_into_a_job_and_posts(session):
    found = session["found"]["editor_decodes_and_posts"]
    assert found["decoded"] == ["program", 1, 0]
    assert {"program.pmc", "program.pkmt", "program-report.json"} <= set(found["files"])
    assert "program.pmc" in found["messages"][0]


def test_cam_menu_has_the_commands(session):
    assert session["found"]["cam_menu_has_the_commands"]["has"] == [True, True, True]


def test_post_command_writes_beside_the_document_and_says_so(session):
    found = session["found"]["post_command_writes_and_tells"]
    assert {"gui.pmc", "gui.pkmt", "gui-setup.pmc", "gui-report.json"} <= set(found["files"])
    assert len(found["told"]) == 1
    assert "gui.pmc" in found["told"][0]


def test_refused_job_is_told_and_leaves_nothing(session):
    found = session["found"]["refused_job_is_told_and_leaves_nothing"]
    assert found["files"] == []
    assert "J105" in found["told"][0]


def test_report_view_has_no_traceback(session):
    found = session["found"]["report_view_has_no_traceback"]
    assert (found["views"], found["tracebacks"]) == (1, 0), found["end"]


def test_window_is_drawn(session):
    assert session["found"]["window_is_drawn"]["saved"]
    assert session["picture"].stat().st_size > 20_000
