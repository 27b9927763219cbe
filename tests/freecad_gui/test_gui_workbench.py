# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench and its commands in a FreeCAD with a window."""

from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("workbench")


def test_workbench_has_its_commands(session):
    found = session["workbench_has_its_commands"]
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
        "Numerical control",
        "Install packages",
    ]
    assert all(found["icons"])


def test_f1_opens_the_page_of_a_command(session):
    pages = {name: Path(page) for name, page in session["commands_have_pages"].items()}
    assert len(pages) == 11
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


def test_cam_has_the_commands_in_its_menu_and_its_tool_bars(session):
    found = session["cam_menu_has_the_commands"]
    assert found["has"] == [True, True, True]
    assert found["bars"] == {
        "Project Setup": "Post to a hexapod",
        "New Operations": "Surface Finish (5-axis)",
        "Path Modification": "Rotate operation",
    }


def test_window_is_drawn(session):
    assert session["window_is_drawn"]["saved"]
    assert session.drew("window.png")
