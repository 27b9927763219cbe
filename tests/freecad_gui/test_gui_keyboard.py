# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tab moves from field to field in every panel, table and page of the workbench."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("keyboard")


def test_tab_comes_to_each_field_from_top_to_bottom_and_goes_back(session):
    steps = {name: step for name, step in session.found.items() if isinstance(step, dict)}
    windows = {
        f"{step} {name}": found
        for step, panels in steps.items()
        for name, found in panels.items()
        if isinstance(found, dict)
    }
    assert len(windows) > 8 and all(found["fields"] > 1 for found in windows.values())
    wrong = {name: found for name, found in windows.items() if found["missed"] or found["order"] or not found["back"]}
    assert wrong == {}


def test_one_press_goes_to_the_next_length_in_the_table_of_tools(session):
    assert session["post_panel"]["rows"] == [0, 1, 2]


def test_one_press_goes_to_the_next_axis_of_a_jog(session):
    assert session["jog_panel"]["next"] == 1


def test_tab_leaves_a_table_that_is_only_read(session):
    assert session["reach_panel"]["leaves the table"]
