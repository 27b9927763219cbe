# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench and its commands in a FreeCAD with a window."""

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


def test_commands_are_active_for_what_they_are_for(session):
    found = session["commands_know_what_they_are_for"]
    assert found == {
        "job": [False, False, True],
        "operation": [True, True, False],
        "controller": [False, False, False],
    }


def test_cam_menu_has_the_commands(session):
    assert session["cam_menu_has_the_commands"]["has"] == [True, True, True]


def test_window_is_drawn(session):
    assert session["window_is_drawn"]["saved"]
    assert session.drew("window.png")
