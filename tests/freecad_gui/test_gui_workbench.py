# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench and its commands in a FreeCAD with a window."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"

GROUPED = [
    *("Surface Finish (5-axis)", "Normal Compensation", "Mirror operation", "Rotate operation", "-"),
    *("Machine", "Reach", "Stiffness", "Simulate", "Post to a hexapod", "-"),
    *("Program editor", "Numerical control", "-"),
    *("New from example", "Install packages"),
]
"""Texts of the commands, with a hyphen for each separator."""


@pytest.fixture(scope="module")
def session(scene):
    return scene("workbench")


def test_workbench_has_its_commands(session):
    found = session["workbench_has_its_commands"]
    assert found["listed"]
    assert found["buttons"] == [text for text in GROUPED if text != "-"]
    assert all(found["icons"])


def test_f1_opens_the_page_of_a_command(session):
    pages = {name: Path(page) for name, page in session["commands_have_pages"].items()}
    assert len(pages) == 13
    assert all(page.is_file() and page.parent.name == "docs" for page in pages.values())
    assert (pages["PKM_Reach"].name, pages["PKM_Mirror"].name) == ("reach.md", "workbench.md")


def test_commands_are_active_for_what_they_are_for(session):
    found = session["commands_know_what_they_are_for"]
    assert found == {
        "job": [False, False, True, True],
        "operation": [True, True, True, True],
        "controller": [False, False, True, True],
        "part": [False, False, True, True],
        "stock": [False, False, True, True],
        "nothing": [False, False, True, True],
        "nothing, two jobs": [False, False, False, False],
        "operation, two jobs": [True, True, True, True],
        "of both jobs": [False, False, False, False],
    }


def test_cam_has_the_same_menu_and_tool_bar_once(session):
    found = session["cam_menu_has_the_commands"]
    assert found["cam"]
    assert found["menus"] == [GROUPED]
    assert found["bars"] == [GROUPED]


@pytest.mark.parametrize("page", ["tutorial.md", "tutorial-blade.md"])
def test_menus_of_a_tutorial_are_in_the_window(page, session):
    there = {path.lower().rstrip(".…") for path in session["menus_have_entries"]}
    text = " ".join((DOCS / page).read_text(encoding="utf-8").split())
    named = re.findall(r"\*((?:Part|CAM|PKM Post) > [^*]+)\*(?: \(\*([^*]+)\*\))?", text)
    assert len(named) > 3
    assert [names for names in named if there.isdisjoint(name.lower() for name in names)] == []


def test_window_is_drawn(session):
    assert session["window_is_drawn"]["saved"]
    assert session.drew("window.png")
