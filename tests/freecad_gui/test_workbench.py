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


def test_window_is_drawn(session):
    assert session["found"]["window_is_drawn"]["saved"]
    assert session["picture"].stat().st_size > 20_000
