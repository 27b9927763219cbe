# SPDX-License-Identifier: LGPL-2.1-or-later
"""The comparison of interpolations: golden numbers, and the table of the documents made again."""

import importlib.util
import re
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "examples" / "tapered_column" / "interpolation.py"


@pytest.fixture(scope="module")
def interpolation():
    spec = importlib.util.spec_from_file_location("tapered_column_interpolation", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def leaning(tilt, turn):
    tilt, turn = np.radians(tilt), np.radians(turn)
    return np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])


# Worked out independently: tilt and change of turn in degrees, and how far angles leave the great circle, in degrees.
@pytest.mark.parametrize(
    ("tilt", "turn", "off"),
    [(5, 90, 1.46), (10, 90, 2.89), (20, 30, 0.63), (30, 30, 0.85), (30, 90, 7.79), (45, 20, 0.44)],
)
def test_angles_leave_the_great_circle(interpolation, tilt, turn, off):
    axis = np.array([leaning(tilt, 0), leaning(tilt, turn)])
    apart = np.cross(axis[0], axis[1])
    sine = interpolation.by_angles(axis)[0] @ (apart / np.linalg.norm(apart))
    assert np.degrees(np.arcsin(np.abs(sine))).max() == pytest.approx(off, abs=0.006)
    assert np.abs(interpolation.by_axis(axis)[0] @ apart).max() < 1e-12


# L (1 - cos(turn / 2)) for L = 200 mm: 1, 2, 5 and 10 degrees.
@pytest.mark.parametrize(("turn", "off"), [(1, 0.0076), (2, 0.030), (5, 0.190), (10, 0.761)])
def test_poses_lift_the_tip(interpolation, turn, off):
    axis = np.array([leaning(-turn / 2, 0), leaning(turn / 2, 0)])
    assert interpolation.tip_by_pose(np.zeros((2, 3)), axis, 200.0).max() == pytest.approx(off, abs=0.0005)


def test_the_table_of_the_documents_is_what_the_script_prints(interpolation):
    reported = (ROOT / "docs" / "planning.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", reported, re.MULTILINE)
    made = interpolation.table(*interpolation.first_quadrant())
    assert [[float(number) for number in row] for row in rows] == [
        [step, round(turn, 3), round(axis, 5), round(platform, 5), round(tip, 5)]
        for step, turn, axis, platform, tip in made
    ]


def test_the_picture_is_drawn(interpolation, tmp_path):
    interpolation.draw([(1, 0.5, 0.002, 0.008, 0.002), (5, 2.5, 0.05, 0.2, 0.05)], tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
