# SPDX-License-Identifier: LGPL-2.1-or-later
"""The script that draws the pictures of docs/feed.md: it draws them, and its figures are those of the page."""

import importlib.util
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def pictures():
    spec = importlib.util.spec_from_file_location("feed_pictures", ROOT / "benchmarks" / "feed_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_no_acceleration_of_the_corner_is_above_its_limit(pictures):
    _, right = pictures.corner().axes
    played = {line.get_label(): line.get_ydata() for line in right.lines}
    assert 0.9 * max(played["limit"]) < max(played["played"]) <= max(played["limit"])


def test_the_times_of_the_scan_are_those_of_the_page(pictures):
    page = (ROOT / "docs" / "feed.md").read_text(encoding="utf-8")
    _, right = pictures.scan().axes
    times = [line.get_label().split(": ")[1] for line in right.lines]
    assert len(times) == 2 and all(time in page for time in times)
