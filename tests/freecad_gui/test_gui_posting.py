# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting from the button in a FreeCAD with a window."""

import pytest


@pytest.fixture(scope="module")
def session(scene):
    return scene("posting")


def test_post_command_writes_beside_the_document_and_says_so(session):
    found = session["post_command_writes_and_tells"]
    assert {"gui.pmc", "gui.pkmt", "gui-setup.pmc", "gui-report.json"} <= set(found["files"])
    assert len(found["told"]) == 1
    assert "gui.pmc" in found["told"][0]


def test_refused_job_is_told_and_leaves_nothing(session):
    found = session["refused_job_is_told_and_leaves_nothing"]
    assert found["files"] == ["refused.FCStd"]
    assert "J105" in found["told"][0]
