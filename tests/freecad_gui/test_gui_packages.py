# SPDX-License-Identifier: LGPL-2.1-or-later
"""Missing packages are offered in the window, and installed from a folder of wheels without a terminal."""

import pytest
from wheels import NAME


@pytest.fixture(scope="module")
def session(scene):
    return scene("packages")


def test_what_is_missing_is_offered_with_its_purpose(session):
    found = session["one_is_missing"]
    assert found["text"] == f"Missing:\n{NAME}: tests"
    assert found["buttons"] == ["Download and install", "Install from a folder...", "Close"]
    assert found["saved"]


def test_a_folder_without_the_wheel_is_named(session):
    found = session["a_folder_without_it_is_refused"]
    assert NAME in found["said"]
    assert found["missing"] == [NAME]


def test_it_is_installed_and_can_be_imported_at_once(session):
    found = session["it_is_installed_from_a_folder"]
    assert found["said"] == "The packages are installed."
    assert found["file"] == str(session.folder / "AdditionalPythonPackages" / f"{NAME}.py")
    assert found["missing"] == []


def test_with_all_packages_it_says_so(session):
    found = session["nothing_is_missing"]
    assert found == {"text": "All packages are installed.", "buttons": ["Close"]}
