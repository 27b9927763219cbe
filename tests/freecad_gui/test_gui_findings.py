# SPDX-License-Identifier: LGPL-2.1-or-later
"""A click on a finding of a refused post goes to operation, command, point and pose of the machine."""

import pytest

CLOSE = 300.0
"""mm: height of the view at a finding, at most."""


@pytest.fixture(scope="module")
def session(scene):
    return scene("findings")


@pytest.mark.parametrize("where", ["in_the_post_panel", "in_the_window_of_cam"])
def test_a_click_goes_to_the_pose(session, where):
    found = session[where]
    assert found["selected"] == ["Custom"] and found["message"].startswith("Cut, ")
    assert found["posed"] and found["height"] <= CLOSE
    assert max(map(abs, found["seen"])) < 100.0  # in the middle is a point of the job, not the machine


def test_closing_leaves_nothing_behind(session):
    assert not session["in_the_post_panel"]["open"] and session["in_the_window_of_cam"]["at rest again"]
    assert session.drew("refused_pose.png")
