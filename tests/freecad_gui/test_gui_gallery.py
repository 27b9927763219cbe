# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every window of the workbench in Chinese and dark at 1366x768, and in light at 200 % of 1920x1080.

    PKM_GALLERY=/tmp/gallery make test ARGS=tests/freecad_gui/test_gui_gallery.py

keeps the pictures of every profile, to be looked at, and takes those of more profiles, which differ in theme alone.
"""

import os
import shutil
from pathlib import Path

import pytest
from profiles import CHINESE, DARK, ENGLISH, LIGHT, write_profile

PROFILES = {
    "chinese_dark": (CHINESE, DARK, "1366x768", "1"),
    "light_200": (ENGLISH, LIGHT, "1920x1080", "2"),
}
if "PKM_GALLERY" in os.environ:
    PROFILES |= {
        "chinese_light": (CHINESE, LIGHT, "1366x768", "1"),
        "dark_200": (ENGLISH, DARK, "1920x1080", "2"),
        "plain": (ENGLISH, None, "1366x768", "1"),
    }
OVERLAY = 380
"""Width of the task overlay of FreeCAD 1.1, in px."""


def profile(name):
    return pytest.param(name, marks=() if name == "chinese_dark" else pytest.mark.slow)


@pytest.fixture(scope="module", params=map(profile, PROFILES))
def session(request, scene, tmp_path_factory):
    language, theme, screen, scale = PROFILES[request.param]
    settings = tmp_path_factory.mktemp(request.param)
    write_profile(settings, language, theme)
    made = scene("gallery", screen, (("FREECAD_USER_HOME", str(settings)), ("QT_SCALE_FACTOR", scale)))
    if folder := os.environ.get("PKM_GALLERY"):
        shutil.copytree(made.folder, Path(folder) / request.param, dirs_exist_ok=True)
    return made


def windows_of(session):
    seen = (pair for step in session.found.values() for pair in step.items())
    return {name: window for name, window in seen if isinstance(window, dict) and "faults" in window}


def test_nothing_is_cut_or_out_of_sight_or_left_in_english(session):
    windows = windows_of(session)
    assert len(windows) > 30
    assert {name: window["faults"] for name, window in windows.items() if window["faults"]} == {}


def test_panels_fit_the_overlay(session):
    windows = windows_of(session)
    names = ("post", "posted", "refused", "reach", "reach_out", "reach check", "PKM_Mirror", "PKM_Rotate", "finish")
    names += ("jog", "stiffness")
    assert {name: windows[name]["width"] for name in names if windows[name]["width"] > OVERLAY} == {}


def test_a_code_in_a_row_is_a_link(session):
    found = session["refusal_of_cam_opens"]["links"]
    assert found["title"] == "K102" and "K102" in found["first"]
    assert found["has"] and found["scrolled"] > 0


def test_the_start_page_has_the_example(session):
    found = session["start_page_has_the_example"]
    assert found["valid"] and found["passes"] > 10


def test_a_gouge_and_dialogs_are_shown(session):
    assert session["a_gouge_is_shown_on_the_part"]["depth"] == pytest.approx(2.5, abs=1e-3)
    assert not session["a_gouge_is_shown_on_the_part"]["valid"]
    assert len(set(session["player_shows_its_pages"]["films"])) == 2


def test_the_control_panel_fits_the_overlay(session):
    widths = {name: window["width"] for name, window in session["control_panel_shows_its_pages"].items()}
    assert {name: width for name, width in widths.items() if width > OVERLAY} == {}


def test_tool_axes_differ_from_the_ground_of_the_view(session):
    found = session["reach_panel_opens"]["axes"]
    assert abs(found["axis"] - found["ground"]) > 80
